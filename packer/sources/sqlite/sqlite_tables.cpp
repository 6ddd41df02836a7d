// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/sqlite/sqlite_tables.hpp"

#include <algorithm>

#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

bool has_tables(const std::filesystem::path& path, std::initializer_list<const char*> tables) {
  try {
    const SqliteFile file(path);
    return std::ranges::all_of(tables, [&file](const std::string& table) {
      return SqliteQuery(file,
                         "SELECT 1 FROM sqlite_master WHERE lower(name)=lower('" + table + "')")
          .step();
    });
  } catch (const SqliteError&) {
    return false;
  }
}

}  // namespace zonepack::packer
