// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"

// What builds leave in a map's folder: packs of earlier versions, parts of killed builds.
namespace zonepack::packer {

struct Leftover {
  std::string name;
  ByteCount bytes = 0;
};

// Files that only a build can have written and that the manifest does not name, sorted: packs
// called as packs are (NAME-<16 hex digits>.zpk) and parts of packs and manifests. Regular files of
// the folder itself only; nothing else is ever listed. Throws std::runtime_error when the manifest
// is missing or damaged, as all packs would be lost then, and while the process that writes a part
// still runs.
std::vector<Leftover> find_leftovers(const std::filesystem::path& folder);

// Throws std::runtime_error when the system refuses.
void remove_leftover(const std::filesystem::path& folder, const Leftover& leftover);

}  // namespace zonepack::packer
