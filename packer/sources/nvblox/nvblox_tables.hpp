// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/record/block_layers.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// What an nvblox map says of its layers.
struct NvbloxTables {
  BlockLayers layers;
  std::vector<std::string> warnings;  // layers and columns that are not carried
};

// Throws std::runtime_error naming the table and what is wrong: no TSDF layer, a layer without one
// of its tables or columns, no block size or one that is no length, layers of different block
// sizes, more metadata than a pack carries.
NvbloxTables read_nvblox_tables(const SqliteFile& file);

}  // namespace zonepack::packer
