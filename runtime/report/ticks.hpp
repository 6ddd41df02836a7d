// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace zonepack::report {

// What the numbers of an axis mean, which decides the positions and labels of its ticks.
enum class Quantity { kNumber, kBytes };

// Round values (1, 2 or 5 times a power of ten; in the largest binary unit for bytes) that cover an
// axis evenly.
struct Ticks {
  double step = 1;
  std::vector<double> values;       // ascending, all inside [low, high]
  std::vector<std::string> labels;  // one per value
};

// About `wanted` ticks in [low, high]. Ends that are not finite, or equal, give the single tick 0.
Ticks make_ticks(double low, double high, int wanted, Quantity quantity = Quantity::kNumber);

// The smallest tick value at or above `high` for an axis from 0; 1 when high is 0 or not finite.
double round_up_to_tick(double high, int wanted, Quantity quantity = Quantity::kNumber);

}  // namespace zonepack::report
