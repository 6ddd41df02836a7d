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

// What labels share the page with.
struct LabelGround {
  std::vector<PxBox> taken;  // other labels: never overlapped
  std::vector<Px> keep;      // better not hidden: routes, portals
  std::vector<Px> spare;     // not hidden where that costs nothing: signatures
};

struct PlacedLabel {
  Px center;
  std::size_t hidden = 0;  // points to keep beneath it
};

// Where a label of this size stands wholly inside the area (rings by the even-odd rule), off what
// is taken, hiding little, far from the border and central. Nothing when it fits nowhere. Looks at
// a grid of places: O(ground + grid * (edges + ground within the area's bounds)).
std::optional<PlacedLabel> place_label(std::span<const std::vector<Px>> rings, double width,
                                       double height, const LabelGround& ground);

// The box of a label around its centre.
PxBox box_around(Px center, double width, double height) noexcept;

}  // namespace zonepack::report
