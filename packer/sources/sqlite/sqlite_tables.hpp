// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace zonepack::packer {

// Whether a file is a SQLite database whose schema names all of these. A database that cannot be
// opened has none.
bool has_tables(const std::filesystem::path& path, std::initializer_list<const char*> tables);

}  // namespace zonepack::packer
