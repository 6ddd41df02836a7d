// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "runtime/report/svg.hpp"

namespace zonepack::report {

struct PxBox {
  Px min, max;
};

struct PlacedLabel {
  Px center;
  std::size_t hidden = 0;  // `avoid` points beneath it
};

// Where a label of this size stands wholly inside the area (rings by the even-odd rule), off the
// boxes already taken, hiding few `avoid` points, far from the border and central. Nothing when it
// fits nowhere. Looks at a grid of places: O(grid * (edges + taken + avoid)).
std::optional<PlacedLabel> place_label(std::span<const std::vector<Px>> rings, double width,
                                       double height, std::span<const PxBox> taken,
                                       std::span<const Px> avoid);

// The box of a label around its centre.
PxBox box_around(Px center, double width, double height) noexcept;

}  // namespace zonepack::report
