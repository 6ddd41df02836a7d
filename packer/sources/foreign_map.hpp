// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace zonepack::packer {

// What a file or folder is that another SLAM system wrote and that cannot be packed, and what to do
// instead: "a Cartographer state (.pbstream); ...". Empty for anything else.
std::string foreign_map(const std::filesystem::path& path);

}  // namespace zonepack::packer
