// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "packer/record/block_layers.hpp"
#include "packer/record/damage.hpp"
#include "packer/record/source_kind.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// A block of one layer: where it lies and the row that holds it.
struct NvbloxBlock {
  std::int32_t x, y, z;
  std::uint32_t zone : 29;
  std::uint32_t layer : 2;
  std::uint32_t wrong_length : 1;
  std::uint32_t row;
};

// Blocks of a cube of 8 x 8 x 8, or of one zone's part of it: a signature.
struct NvbloxCube {
  std::int32_t id = 0;
  std::size_t first = 0, count = 0;  // of NvbloxMap::blocks
  std::array<double, 3> base{};      // the centre of the block nearest to their middle
  std::optional<Damage> damage;
};

// Where the blocks of an nvblox map are. The voxels stay in the file.
//
// Memory: 20 bytes a block of each layer, of which there are at most kMostBlocks, and 100 a cube.
struct NvbloxMap {
  static constexpr std::size_t kMostBlocks = std::size_t{8} << 20;

  BlockLayers layers;
  Bytes layers_info;
  std::vector<NvbloxBlock> blocks;  // by cube, zone, layer, place in the cube
  std::vector<NvbloxCube> cubes;    // by id
  std::array<std::uint64_t, 4> block_count{};
  std::uint64_t source_bytes = 0;
  std::vector<std::string> warnings, notes;
};

// Throws std::runtime_error naming table, row and what is wrong. What is wrong with one block is
// the damage of its cube.
NvbloxMap read_nvblox_map(const SqliteFile& file, const SourceOptions& options);

// "tsdf_layer_data: block (1, -2, 3)".
std::string block_text(const NvbloxBlock& block);
// "expected 4096 bytes, found 100": what a block of the layer takes.
std::string length_problem(std::size_t layer, std::uint64_t found);
std::size_t block_bytes_of(std::size_t layer) noexcept;
std::uint32_t place_of(const NvbloxBlock& block) noexcept;

}  // namespace zonepack::packer
