// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// Where two zones meet.
namespace zonepack::packer {

inline constexpr std::size_t kMostBorderPieces = 16384;

// The pieces along which the outlines of two polygons run side by side with their interiors on
// opposite sides: at most `separation_m` apart and within 15 degrees of parallel. Each piece lies
// midway between the two outlines (on them when they coincide). Adjacent pieces in one line are one
// piece; pieces shorter than `min_length_m` are left out. In the order of a's edges. Both polygons
// have their interior on the left (with_interior_on_the_left). nullopt when there are more than
// kMostBorderPieces before they are joined.
std::optional<std::vector<Segment2>> shared_borders(const Polygon& a, const Polygon& b,
                                                    double separation_m, double min_length_m);

// The point of the pieces nearest to `point`; nullopt when there are no pieces.
std::optional<Point2> nearest_point(const std::vector<Segment2>& pieces, Point2 point) noexcept;

}  // namespace zonepack::packer
