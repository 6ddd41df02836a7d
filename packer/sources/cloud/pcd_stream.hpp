// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "packer/sources/cloud/point_stream.hpp"

namespace zonepack::packer {

// Opens a PCD file in any of its three encodings. A compressed one is decompressed into a temporary
// file first. Points that are not finite are handed on as they are. Throws std::runtime_error: no
// fields x, y, z; a file shorter than its header says; a line of another shape.
std::unique_ptr<PointStream> open_pcd(const std::string& path);

}  // namespace zonepack::packer
