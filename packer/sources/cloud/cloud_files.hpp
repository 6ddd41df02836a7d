// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "packer/sources/cloud/cloud_map.hpp"

namespace zonepack::packer {

// Whether a folder holds Autoware's map tiles: .pcd files and a YAML file of their corners.
bool is_autoware_tiles(const std::filesystem::path& folder);
// A folder of Autoware's tiles: each file is a tile. Points outside of the square that the YAML
// file gives their tile are warned of. Throws std::runtime_error.
std::unique_ptr<CloudMap> open_autoware_tiles(const std::filesystem::path& folder);

// Whether a folder is a dump of GLIM: graph.txt and submaps of data.txt and points_compact.bin.
bool is_glim_dump(const std::filesystem::path& folder);
// A dump of GLIM: each submap is a tile, its points in the frame of the submap's origin. Throws
// std::runtime_error.
std::unique_ptr<CloudMap> open_glim_dump(const std::filesystem::path& folder);

}  // namespace zonepack::packer
