// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "packer/outline/map_drawing.hpp"

// Grids as ROS map_server keeps them: a YAML file, and the image that it names.
namespace zonepack::packer {

// A larger image is no floor plan: at 5 cm, this is 400 m by 400 m.
inline constexpr std::size_t kMostServedCells = std::size_t{1} << 26;

// The grid's lower left corner is at (x_min_m, y_min_m) of `image`, and its rows run along
// `yaw_rad`, counter-clockwise from x, around that corner.
struct GridFile {
  MapImage image;
  double yaw_rad = 0;
  std::string image_file;
};

// Reads the keys image, resolution, origin, negate, occupied_thresh, free_thresh and mode
// (trinary, scale, raw), as nav2_map_server does; the image is a PGM (P2, P5) or a PNG file. Throws
// std::runtime_error that names the file, the key and what was expected.
GridFile read_grid_file(const std::filesystem::path& yaml);

// The grid as the floor plan of a map in the same frame.
MapDrawing drawing_of(GridFile map);

}  // namespace zonepack::packer
