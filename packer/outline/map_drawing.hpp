// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "packer/outline/map_image.hpp"
#include "packer/record/map_source.hpp"

namespace zonepack::packer {

// The floor plan of a map, and where it comes from.
struct MapDrawing {
  MapImage image;      // without cells when nothing is known
  std::string source;  // "local grids"
  std::size_t grids = 0;
  std::vector<std::string> warnings;
};

// The database's own map or, without one, what the local grids of its signatures add up to; leaves
// out grids that are damaged, with a warning. Throws std::runtime_error as OccupancyMap does.
MapDrawing drawing_of(MapSource& source);

}  // namespace zonepack::packer
