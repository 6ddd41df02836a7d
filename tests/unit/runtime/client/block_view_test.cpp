// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/block_view.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "packer/encode/pack_writer.hpp"
#include "platform/memory/shared_memory.hpp"
#include "runtime/client/shared_reader.hpp"
#include "runtime/client/zonepack_client.h"
#include "runtime/pack_format/file/pack_reader.hpp"
#include "tests/support/shared_zones.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

// A zone of 20 signatures with blocks: 3 of TSDF would be one record, 40 are several.
class Blocks : public testing::Test {
 protected:
  static packer::SignatureRecord record(std::int32_t id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.features = 0;
    recipe.blocks = true;
    return test_support::make_signature(recipe);
  }

  static DecodedPack decoded() {
    const test_support::TemporaryFolder folder;
    packer::PackWriter writer(folder.path(), "zone", kPackMinorOfBlocks);
    for (std::int32_t id = 1; id <= 20; ++id) {
      packer::SignatureRecord one = record(id);
      writer.add(one, 0, 0);
    }
    const auto reader = PackReader::open(folder / writer.finish(kEveryPayload).file);
    return DecodedPack::decode(*reader, kEveryPayload).value();
  }

  // Blocks at places 3 (1, 1, 0) and 72 (6, 0, 0) of cube (id, -1, 0).
  static BlockPosition first_of(std::int32_t id) { return {8 * id + 1, -8 + 1, 0}; }
  static BlockPosition second_of(std::int32_t id) { return {8 * id + 6, -8, 0}; }

  const DecodedPack pack_ = decoded();
  const BlocksView blocks_{pack_.view()};
};

TEST_F(Blocks, AreFoundByTheirIndexAndNoOtherIs) {
  EXPECT_EQ(blocks_.size(), 40u);
  EXPECT_EQ(blocks_.block_size_m(), 0.5);
  std::size_t found = 0;
  for (std::int32_t x = 0; x < 180; ++x) {
    for (std::int32_t y = -10; y < 2; ++y) {
      for (std::int32_t z = -1; z < 5; ++z) {
        const auto block = blocks_.find(x, y, z);
        found += block.has_value();
        if (block) {
          EXPECT_EQ(block->position(), (BlockPosition{x, y, z}));
        }
      }
    }
  }
  EXPECT_EQ(found, 40u);
  EXPECT_FALSE(blocks_.find(2147483647, -2147483647 - 1, 0));
}

TEST_F(Blocks, GiveBackEveryLayerBitForBit) {
  for (std::int32_t id = 1; id <= 20; ++id) {
    const packer::BlockCube cube = *record(id).blocks;
    const BlockPosition p = second_of(id);
    const auto block = blocks_.find(p.x, p.y, p.z);
    ASSERT_TRUE(block);
    for (std::uint32_t i = 0; i < kVoxelLayers; ++i) {
      const auto layer = static_cast<VoxelLayer>(i);
      ASSERT_TRUE(block->has(layer));
      packer::Bytes copy(bytes_of_block(planes_of(layer)));
      ASSERT_TRUE(block->copy(layer, copy));
      const std::size_t at = i == 0 ? 4096 : 0;  // its second TSDF block
      EXPECT_EQ(std::memcmp(copy.data(), cube.layers[i].voxels.data() + at, copy.size()), 0);
    }
    const BlockPosition q = first_of(id);
    EXPECT_TRUE(blocks_.find(q.x, q.y, q.z)->has(VoxelLayer::kTsdf));
    EXPECT_FALSE(blocks_.find(q.x, q.y, q.z)->has(VoxelLayer::kEsdf));
  }
}

TEST_F(Blocks, GiveSingleVoxelsInPlace) {
  const BlockPosition p = second_of(7);
  const BlockView block = *blocks_.find(p.x, p.y, p.z);
  std::array<TsdfVoxel, 512> tsdf;
  std::array<EsdfVoxel, 512> esdf;
  ASSERT_TRUE(block.copy_tsdf(tsdf));
  ASSERT_TRUE(block.copy_esdf(esdf));
  for (std::uint32_t x = 0; x < 8; ++x) {
    for (std::uint32_t z = 0; z < 8; ++z) {
      const std::uint32_t i = x * 64 + 3 * 8 + z;
      EXPECT_EQ(block.tsdf_at(x, 3, z)->distance_m, tsdf[i].distance_m);
      EXPECT_EQ(block.tsdf_at(x, 3, z)->weight, tsdf[i].weight);
      EXPECT_EQ(block.esdf_at(x, 3, z)->squared_distance, static_cast<float>(x * x));
      EXPECT_EQ(block.esdf_at(x, 3, z)->parent[0], -static_cast<std::int32_t>(x));
      EXPECT_EQ(esdf[i].observed, 1);
    }
  }
  // Block (62, -8, 0) of 0.5 m begins at (31, -4, 0).
  EXPECT_EQ(blocks_.at(31.1, -3.6, 0.4)->position(), p);
  EXPECT_FALSE(blocks_.at(31.1, -3.4, 0.4));
  EXPECT_FALSE(blocks_.at(1e300, 0, 0));
}

TEST_F(Blocks, AreReadFromSharedMemoryAndThroughTheCInterface) {
  const auto slots = test_support::SharedZones::slots_for(pack_.chunks());
  SharedMemory memory = SharedMemory::create("zonepack-test", shared_map_bytes(1, slots)).value();
  test_support::SharedZones zones(memory.bytes(), 1, slots);
  zones.put(0, pack_.chunks());
  zp_status status;
  zp_client* const client = zp_open_memory(memory.bytes().data(), memory.bytes().size(), &status);
  ASSERT_NE(client, nullptr);
  int reads = 0;
  const auto read = [](const zp_zone* zone, void* user) {
    ++*static_cast<int*>(user);
    EXPECT_EQ(zp_block_count(zone), 40u);
    EXPECT_EQ(zp_block_size(zone), 0.5);
    zp_block block;
    const BlockPosition p = second_of(9);
    ASSERT_EQ(zp_find_block(zone, p.x, p.y, p.z, &block), 1);
    EXPECT_EQ(block.layers, 15u);
    EXPECT_EQ(zp_find_block(zone, p.x, p.y, p.z + 1, &block), 0);
    EXPECT_EQ(zp_get_block(zone, 39, &block), 1);
    EXPECT_EQ(zp_get_block(zone, 40, &block), 0);
    packer::Bytes copy(10240);
    const packer::BlockCube cube = *record(9).blocks;
    EXPECT_EQ(zp_copy_block(zone, p.x, p.y, p.z, ZP_ESDF, copy.data(), copy.size()), 1);
    EXPECT_EQ(copy, cube.layers[3].voxels);
    EXPECT_EQ(zp_copy_block(zone, p.x, p.y, p.z, ZP_ESDF, copy.data(), 4096), 0);
    EXPECT_EQ(zp_copy_block(zone, p.x, p.y, p.z, ZP_TSDF, copy.data(), 4095), 0);
  };
  EXPECT_EQ(zp_read(client, 0, read, &reads), ZP_OK);
  EXPECT_EQ(reads, 1);
  zp_close(client);
}

// The memory of a zone that is overwritten while it is read: wrong voxels, but none from outside.
TEST_F(Blocks, StayInsideTheirBytesWhateverTheseBecome) {
  const auto slots = test_support::SharedZones::slots_for(pack_.chunks());
  SharedMemory memory = SharedMemory::create("zonepack-test", shared_map_bytes(1, slots)).value();
  test_support::SharedZones zones(memory.bytes(), 1, slots);
  zones.put(0, pack_.chunks());
  SharedReader reader = SharedReader::open(memory.bytes()).value();
  const auto status = reader.read(0, [&](const ZoneSignatures& zone) {
    const std::vector<std::byte> before(memory.bytes().begin(), memory.bytes().end());
    std::array<EsdfVoxel, 512> esdf;
    for (const unsigned fill : {0x00u, 0xFFu, 0x55u, 0x03u, 0x0Bu, 0x21u}) {
      std::memset(memory.bytes().data() + memory.bytes().size() - std::size_t{slots} * kSlotBytes,
                  static_cast<int>(fill), std::size_t{slots} * kSlotBytes);
      zone.blocks().for_each([&](const BlockView& block) {
        block.copy_esdf(esdf);
        for (std::uint32_t i = 0; i < 8; ++i) block.tsdf_at(i, i, i);
      });
    }
    std::memcpy(memory.bytes().data(), before.data(), before.size());
  });
  EXPECT_EQ(status, ReadStatus::kOk);
}

}  // namespace
}  // namespace zonepack
