// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/outline/map_drawing.hpp"
#include "packer/tune/tune.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::packer::tune {

struct TunePage {
  std::string folder;  // of the map
  ByteCount budget = 0;
  const Layout* before = nullptr;
  const Tuned* tuned = nullptr;
  const MapDrawing* ground = nullptr;
};

// "split L1 -> L1_1, L1_2" and "merge R41, R42 -> R41+R42".
std::string change_text(const Step& step);
// In MiB with a sign where it is less than nothing: "0.31", "-0.02".
std::string saved_mib_text(std::int64_t bytes);

// One page: the zones before and after with the drives over them, what was changed, and what was
// not.
report::Report make_tune_page(const TunePage& page);

}  // namespace zonepack::packer::tune
