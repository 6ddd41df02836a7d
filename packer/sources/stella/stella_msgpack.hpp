// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "packer/sources/stella/stella_map.hpp"

namespace zonepack::packer {

// Whether a file begins as a MessagePack map whose first key is one of a stella_vslam map's.
bool begins_as_stella_msgpack(const std::filesystem::path& path);

// A map that stella_vslam or OpenVSLAM saved as MessagePack (2019 to 2026). Throws
// std::runtime_error.
//
// Memory: all keyframes' features, about 60 bytes a keypoint; less than the file is long.
StellaFile open_stella_msgpack(const std::filesystem::path& path);

}  // namespace zonepack::packer
