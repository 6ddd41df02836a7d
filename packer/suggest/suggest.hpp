// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "packer/suggest/free_space.hpp"
#include "packer/suggest/rivals.hpp"
#include "packer/zones/zone_plan.hpp"

// Zones from an occupancy grid: rooms, corridors and the doors between them.
//
// The same grid gives the same zones on every machine: clearance is measured in squares of whole
// cells, and coordinates are multiples of a cell's side.
namespace zonepack::packer::suggest {

enum class Method : std::uint8_t { kBasins, kGrid, kPath };

struct Options {
  Method method = Method::kBasins;
  double door_ratio = 0.8;
  double min_area_m2 = 1.5;
  double max_length_m = 0;      // 0: corridors of any length
  double square_m = 5;          // kGrid
  std::vector<PathPlace> path;  // kPath
};

// Where a grid lies in the map.
struct GridPlace {
  Point2 corner;            // the lower left corner of cell 0
  double cos = 1, sin = 0;  // of its yaw
};

struct Suggestion {
  ZonePlan plan;
  Regions regions;                 // of each cell: the index into plan.zones
  std::vector<std::string> apart;  // zones that no portal leads to
  std::size_t dropped_cells = 0;   // free cells in no zone
};

// Throws std::runtime_error when nothing is free, free ground falls into more than 2^19 pieces, a
// zone has more vertices than a pack can hold, or all have more than a zone file.
Suggestion suggest(FreeSpace space, const GridPlace& place, const Options& options);

// The rooms alone, as regions of cells; what suggest() draws zones around. Frees clutter.
Regions rooms_of(FreeSpace& space, const Options& options);

}  // namespace zonepack::packer::suggest
