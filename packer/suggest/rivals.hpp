// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "packer/suggest/regions.hpp"

// Partitions that know nothing of rooms, to compare with.
namespace zonepack::packer::suggest {

// Squares of a grid, wherever some of a square is free; walls within a square belong to it.
Regions squares_of(const FreeSpace& space, double side_m);

// A place on the path of the mapping robot, and the stretch of the path that it belongs to.
struct PathPlace {
  CellIndex cell = 0;
  std::int32_t stretch = 0;
};

// Every free cell goes to the stretch that it is nearest to on foot; what cannot be reached from
// the path belongs to none.
Regions stretches_of(const FreeSpace& space, std::span<const PathPlace> path);

// Cuts regions longer than `most_m`, measured along the way, across into equal lengths.
void cut_long(Regions& regions, const FreeSpace& space, double most_m);

}  // namespace zonepack::packer::suggest
