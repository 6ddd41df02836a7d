// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "packer/record/map_outline.hpp"

// An occupancy grid as an image, and its file formats.
namespace zonepack::packer {

enum class Cell : std::uint8_t { kUnknown, kFree, kOccupied };

struct MapImage {
  std::size_t width = 0, height = 0;
  double resolution_m = 0;
  double x_min_m = 0, y_min_m = 0;  // outer corner of cell (0, 0), map frame
  std::vector<Cell> cells;          // row by row, row 0 at y_min

  Cell at(std::size_t column, std::size_t row) const { return cells.at(row * width + column); }
  std::size_t count(Cell cell) const;
};

// The shortest decimal number that gives this float32: 0.05f is 0.05, not 0.0500000007.
double decimal_of(float value);

// The grid that RTAB-Map assembled, as an image.
MapImage image_of(const OptimisedMap& map);

// For ROS map_server: a binary PGM (row 0 at the top: 0 occupied, 254 free, 205 unknown), its YAML
// and, for QGIS, a world file.
std::string to_pgm(const MapImage& image);
std::string map_yaml(const MapImage& image, const std::string& image_name);
std::string world_file(const MapImage& image);

}  // namespace zonepack::packer
