// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "runtime/report/chart.hpp"

// Fewer samples that say nearly the same, so that the size of a page has a bound.
namespace zonepack::report {

// Up to three values at a time; the first is not finite where nothing is known.
struct Waypoint {
  double t_s = 0;
  std::array<double, 3> value{};
};

// The indices of points between which straight lines miss no other point by more than `tolerance`
// of each value: a swinging door, one pass. While more than `most` are left, with twice the
// tolerance; beyond 40 times that, every k-th point.
std::vector<std::size_t> corners_of(std::span<const Waypoint> points,
                                    std::array<double, 3> tolerance, std::size_t most);

// The samples at which a value that holds until the next one changes, and the last. Of more than
// `most`, the largest of every k stays.
std::vector<Sample> changes_of(std::span<const Sample> samples, std::size_t most);

}  // namespace zonepack::report
