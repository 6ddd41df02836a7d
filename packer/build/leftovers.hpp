// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"

// What builds leave behind in a map's folder: packs of earlier versions, parts of killed builds.
namespace zonepack::packer {

struct Leftover {
  std::string name;
  ByteCount bytes = 0;
};

// Files that only a build can have written and that the manifest does not name, sorted: files with
// the name of a pack (NAME-<16 hex digits>.zpk) and parts of packs and manifests. Lists regular
// files of the folder itself only. Throws std::runtime_error when the manifest is missing or
// damaged, since all packs would be lost then, and while the process that writes a part still runs.
std::vector<Leftover> find_leftovers(const std::filesystem::path& folder);

// Removes parts of packs and manifests whose writer is gone. What cannot be removed stays.
void remove_parts_of_killed(const std::filesystem::path& folder) noexcept;

// Throws std::runtime_error when the file cannot be removed.
void remove_leftover(const std::filesystem::path& folder, const Leftover& leftover);

}  // namespace zonepack::packer
