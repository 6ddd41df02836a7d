// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// Cutting a polygon by straight lines. Metres in the map frame.
namespace zonepack::packer {

// A unit vector u. A line across it is identified by its position along it, `at(p) = p . u`.
struct Axis {
  double ux = 1, uy = 0;
  double at(Point2 p) const noexcept { return p.x_m * ux + p.y_m * uy; }
  Axis across() const noexcept { return {-uy, ux}; }
};

// The direction of a polygon's length: the longer side of its bounding rectangle of least area,
// pointing to greater x (to greater y when it is parallel to y). Among rectangles of equal area,
// and in a square, the direction nearer to x.
Axis length_of(const Polygon& polygon);

struct Pieces {
  std::vector<Polygon> below, above;  // ordered across the axis
};

// Cuts along the line { p : axis.at(p) = place }. Each piece is connected and keeps its interior on
// the left; a side that falls apart (a U cut through both legs) gives several.
// Both sides of the cut get exactly the same points. No vertex may lie on the line: see
// place_between().
Pieces cut(const Polygon& polygon, const Axis& axis, double place);

// A position between `from` and `to` without a vertex: their middle or, when a vertex is within a
// tenth of the gap of it, the middle of the widest stretch without vertices.
double place_between(const Polygon& polygon, const Axis& axis, double from, double to);

}  // namespace zonepack::packer
