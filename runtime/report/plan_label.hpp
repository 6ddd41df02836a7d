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

// What else is on the page.
struct LabelGround {
  std::vector<PxBox> taken;  // other labels: never overlapped
  std::vector<Px> keep;      // best not hidden: routes, portals
  std::vector<Px> spare;     // not hidden if that costs nothing: signatures
};

struct PlacedLabel {
  Px center;
  std::size_t hidden = 0;  // points of `keep` below it
};

// Places a label of this size wholly inside the area (rings by the even-odd rule) and off the taken
// boxes, so that it hides little and is central and far from the border. Nothing when it fits
// nowhere. Tries a grid of positions: O(ground + grid * (edges + ground within the area's bounds)).
std::optional<PlacedLabel> place_label(std::span<const std::vector<Px>> rings, double width,
                                       double height, const LabelGround& ground);

// The box of a label around its centre.
PxBox box_around(Px center, double width, double height) noexcept;

}  // namespace zonepack::report
