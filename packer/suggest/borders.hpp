// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "packer/suggest/regions.hpp"

// The borders of regions as a planar graph on the corners of cells. A border is traced once for
// both regions that share it, so neighbours get the same points.
namespace zonepack::packer::suggest {

// A corner of cells: (0, 0) is the lower left corner of cell 0.
struct Corner {
  std::int32_t x = 0, y = 0;
  friend bool operator==(const Corner&, const Corner&) = default;
};

inline std::int64_t distance2(Corner a, Corner b) noexcept {
  return std::int64_t{a.x - b.x} * (a.x - b.x) + std::int64_t{a.y - b.y} * (a.y - b.y);
}

// Positive where `p` is to the left of the line from `a` to `b`.
inline std::int64_t side(Corner a, Corner b, Corner p) noexcept {
  return std::int64_t{b.x - a.x} * (p.y - a.y) - std::int64_t{b.y - a.y} * (p.x - a.x);
}

// A line along cell edges from one node (where three regions meet, or two regions and a wall) to
// the next; a loop without nodes begins and ends at its first corner.
struct Border {
  Region left = kNoRegion, right = kNoRegion;  // in the direction of the corners; one is a region
  std::vector<Corner> corners;
  bool between_regions() const noexcept { return left != kNoRegion && right != kNoRegion; }
};

// All borders, in the order of their first corners.
std::vector<Border> trace_borders(const Regions& regions, const FreeSpace& space);

// Fewer corners along the same border: every cell along it keeps its centre on its side, so a
// simplified region holds the centres of its own cells and no others, and borders never cross.
Border simplified(const Border& border);

// The outline of each region from (simplified) borders: closed rings of corners without the first
// repeated, counter-clockwise the outer one, which comes first, clockwise the holes.
std::vector<std::vector<std::vector<Corner>>> rings_of(const std::vector<Border>& borders,
                                                       std::int32_t regions);

}  // namespace zonepack::packer::suggest
