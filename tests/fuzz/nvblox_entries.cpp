// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/nvblox_entries.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "packer/encode/voxel_encoder.hpp"
#include "packer/record/block_layers.hpp"
#include "runtime/pack_format/column.hpp"
#include "runtime/pack_format/voxel_block.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;

constexpr std::array<std::uint32_t, 4> kPlanes = {2, 2, 1, 5};

Bytes block_with(std::byte first, ByteSpan block) {
  Bytes out(1, first);
  out.insert(out.end(), block.begin(), block.end());
  return out;
}

packer::BlockCube some_cube() {
  test_support::SignatureRecipe recipe;
  recipe.blocks = true;
  return *test_support::make_signature(recipe).blocks;
}

Bytes database(const packer::BlockCube& cube) {
  const test_support::TemporaryFolder folder;
  const std::string path = (folder / "seed.nvblx").string();
  sqlite3* handle = nullptr;
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  require(sqlite3_open(path.c_str(), &handle) == SQLITE_OK);
  const packer::BlockLayers layers = packer::read_block_layers(cube.layers_info);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string name = packer::kBlockLayerNames[i];
    const std::string sql = layers.layers[i]->metadata_sql + ";" + layers.layers[i]->data_sql +
                            ";INSERT INTO " + name +
                            "_metadata VALUES ('block_size',NULL,NULL,0.5)";
    require(sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
    const std::size_t bytes = bytes_of_block(kPlanes[i]);
    for (std::size_t k = 0; k < cube.layers[i].place.size(); ++k) {
      sqlite3_stmt* insert = nullptr;
      const std::string row = "INSERT INTO " + name + "_data VALUES (?1,2,-3,?2)";
      require(sqlite3_prepare_v2(handle, row.c_str(), -1, &insert, nullptr) == SQLITE_OK);
      sqlite3_bind_int(insert, 1, static_cast<int>(k));
      sqlite3_bind_blob(insert, 2, cube.layers[i].voxels.data() + k * bytes,
                        static_cast<int>(bytes), SQLITE_STATIC);
      require(sqlite3_step(insert) == SQLITE_DONE);
      sqlite3_finalize(insert);
    }
  }
  sqlite3_close(handle);
  return test_support::read_bytes(path);
}

NvbloxSeeds make_nvblox_seeds() {
  NvbloxSeeds seeds;
  const packer::BlockCube cube = some_cube();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t bytes = bytes_of_block(kPlanes[i]);
    for (std::size_t k = 0; k < cube.layers[i].place.size(); ++k) {
      Bytes block;
      packer::encode_block(ByteSpan(cube.layers[i].voxels).subspan(k * bytes, bytes), kPlanes[i],
                           block);
      seeds.voxels.push_back(block_with(static_cast<std::byte>(kPlanes[i] - 1), block));
    }
  }
  seeds.files = {database(cube)};
  seeds.layers = {cube.layers_info};
  return seeds;
}

}  // namespace

bool read_voxels(ByteSpan bytes) {
  if (bytes.empty() || bytes.size() > 20000) return false;
  const std::uint32_t planes = std::to_integer<std::uint32_t>(bytes[0]) % kMostPlanes + 1;
  // Exactly as long as readers are promised, so that a read behind it is seen.
  const std::size_t size = bytes.size() - 1;
  const std::unique_ptr<std::byte[]> own(new std::byte[size + kColumnPadding]);
  std::memcpy(own.get(), bytes.data() + 1, size);
  std::memset(own.get() + size, 0xA5, kColumnPadding);
  const ByteSpan block{own.get(), size};
  VoxelPlanes parsed;
  if (!parse_block(block, planes, parsed)) return false;
  VoxelPlane::Values values;
  bool exact = true;
  for (std::uint32_t p = 0; p < planes; ++p) {
    parsed[p].copy(values);
    exact = parsed[p].is_exact() && exact;
    for (std::uint32_t i = 0; i < kVoxelsOfBlock; ++i) {
      if (parsed[p].at(i) != values[i]) std::abort();
    }
  }
  Bytes plain(bytes_of_block(planes));
  if (!copy_block(block, planes, plain)) std::abort();
  read_plain_voxels(plain);
  // As memory that changes after it was parsed.
  std::memset(own.get(), std::to_integer<int>(bytes.back()), size);
  for (std::uint32_t p = 0; p < planes; ++p) {
    parsed[p].copy(values);
    values[0] = parsed[p].at(511);
  }
  return exact;
}

bool read_plain_voxels(ByteSpan bytes) {
  for (const std::uint32_t planes : {1u, 2u, 5u}) {
    Bytes blob(bytes_of_block(planes));
    std::memcpy(blob.data(), bytes.data(), std::min(blob.size(), bytes.size()));
    Bytes block;
    packer::encode_block(blob, planes, block);  // compares
    if (block.size() > planes * 2050) std::abort();
  }
  return true;
}

bool read_layers(ByteSpan bytes) {
  try {
    const packer::BlockLayers layers = packer::read_block_layers(bytes);
    return packer::read_block_layers(packer::write_block_layers(layers)).block_size_m ==
           layers.block_size_m;
  } catch (const std::runtime_error&) {
    return false;
  }
}

const NvbloxSeeds& nvblox_seeds() {
  static const NvbloxSeeds all = make_nvblox_seeds();
  return all;
}

}  // namespace zonepack::fuzz
