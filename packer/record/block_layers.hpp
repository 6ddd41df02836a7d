// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// nvblox's names of the layers of a BlockCube, in its order.
inline constexpr std::array<const char*, 4> kBlockLayerNames = {"tsdf_layer", "color_layer",
                                                                "occupancy_layer", "esdf_layer"};

// A value of a table, as SQLite stores it.
using TableCell = std::variant<std::monostate, std::int64_t, double, std::string, Bytes>;

// The two tables of one layer, but for its blocks.
struct BlockLayerTables {
  std::string metadata_sql, data_sql;            // CREATE TABLE …, as the source has it
  std::vector<std::vector<TableCell>> metadata;  // rows, all of the same length
};

// What the layers of a map of blocks say of themselves.
struct BlockLayers {
  double block_size_m = 0;
  std::array<std::optional<BlockLayerTables>, 4> layers;
};

// As BlockCube::layers_info has it (FORMAT.md: BlockLayers).
Bytes write_block_layers(const BlockLayers& layers);

// Throws std::runtime_error where the bytes are not whole. SQL is not examined: who runs it
// must not trust it.
BlockLayers read_block_layers(std::span<const std::byte> bytes);

}  // namespace zonepack::packer
