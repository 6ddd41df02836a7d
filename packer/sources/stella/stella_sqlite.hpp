// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "packer/sources/stella/stella_map.hpp"

namespace zonepack::packer {

// A map that stella_vslam saved as a SQLite database, read-only. Features stay in the file until
// they are read. Throws SqliteError.
StellaFile open_stella_sqlite(const std::filesystem::path& path);

}  // namespace zonepack::packer
