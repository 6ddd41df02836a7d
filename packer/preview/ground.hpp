// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "packer/decode/map_reader.hpp"
#include "packer/outline/map_drawing.hpp"
#include "runtime/report/floor_plan.hpp"

// The occupancy grid that pictures of a map show below its zones.
namespace zonepack::packer {

// More cells than this are merged into larger ones, so that no picture grows past a few hundred
// kilobytes; a merged cell is occupied where any of its cells is.
inline constexpr std::size_t kMostRasterCells = 1'000'000;

// The grid as a picture; nothing when it has no cells.
std::optional<report::PlanRaster> raster_of(const MapImage& image,
                                            std::size_t most_cells = kMostRasterCells);

// The same of one whose rows may be turned: a picture of the box around it, with pixels along x and
// y. A pixel shows what is below four points of each cell's size; around the grid nothing is known.
std::optional<report::PlanRaster> raster_of(const MapDrawing& drawing,
                                            std::size_t most_cells = kMostRasterCells);

// What the signatures in a map's packs show, by their optimised poses: local grids or, without
// any, a slice of points or voxels at the usual heights. A pack that cannot be read is left out,
// with a warning; where nothing is shown the image has no cells.
MapDrawing drawing_of(const MapReader& map);

}  // namespace zonepack::packer
