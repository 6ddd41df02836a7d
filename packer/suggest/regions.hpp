// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "packer/suggest/free_space.hpp"

// Free space cut into regions: which region each cell belongs to.
namespace zonepack::packer::suggest {

using Region = std::int32_t;
inline constexpr Region kNoRegion = -1;

// Regions are numbered from 0 without a gap; each is connected by edges.
struct Regions {
  std::int32_t count = 0;
  std::vector<Region> of_cell;

  Region at(CellIndex cell) const noexcept { return of_cell[static_cast<std::size_t>(cell)]; }
  Region& at(CellIndex cell) noexcept { return of_cell[static_cast<std::size_t>(cell)]; }
};

std::vector<std::size_t> cells_of_each(const Regions& regions);

// Cuts regions that fell apart into connected ones; numbers all by their lowest cell.
void renumber(Regions& regions, const FreeSpace& space);

// Regions without neighbours that are dropped: smaller ones, and those that are nowhere as wide,
// where no robot stands.
struct Islets {
  double least_m2 = 0, least_width_m = 0;
};

// Folds each region under `least_m2` into the neighbour with the widest pass, smallest first, and
// drops islets. `clearance2` as from squared_clearance().
void fold_small(Regions& regions, const FreeSpace& space,
                const std::vector<std::int32_t>& clearance2, double least_m2, const Islets& islets);

// Gives cells inside a region's outline that belong to none to this region, where such a gap is
// smaller than `most_m2` and touches no other region.
void fill_gaps(Regions& regions, const FreeSpace& space, double most_m2);

// Changes single cells until no region touches itself at a corner only, so that outlines do not
// touch themselves.
void open_corners(Regions& regions, const FreeSpace& space);

}  // namespace zonepack::packer::suggest
