// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/shared_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

namespace zonepack {
namespace {

class Shared : public testing::Test {
 protected:
  static constexpr std::uint32_t kZones = 3, kSlots = 4;
  const std::size_t bytes = shared_map_bytes(kZones, kSlots);
  std::unique_ptr<std::byte, decltype(&std::free)> block{
      static_cast<std::byte*>(std::aligned_alloc(4096, bytes)), std::free};
  std::span<std::byte> memory{block.get(), bytes};

  void SetUp() override { std::fill(memory.begin(), memory.end(), std::byte{0}); }

  const SharedHeader& header() { return *reinterpret_cast<SharedHeader*>(block.get()); }
  SharedZone& zone(ZoneId id) {
    return reinterpret_cast<SharedZone*>(block.get() + header().zones_at)[id];
  }
};

TEST_F(Shared, LaysOutSlotsOnPagesBehindItsTables) {
  auto map = SharedMap::lay_out(memory, kZones, kSlots);
  ASSERT_TRUE(map.ok());
  EXPECT_TRUE(shared_header_is_sound(header(), bytes));
  EXPECT_EQ(header().slots_at % 4096, 0u);
  EXPECT_EQ(map->slot(3).data() + kSlotBytes, block.get() + bytes);
  EXPECT_EQ(map->chunks(0)[0].bytes, 0u);
  EXPECT_EQ(map->links().size(), kSlots);
}

TEST_F(Shared, ShowsAZoneFromPublishToWithdraw) {
  auto map = SharedMap::lay_out(memory, kZones, kSlots);
  ASSERT_TRUE(map->begin_map(3).ok());
  map->publish(1, 7, {2, 3, 2});
  EXPECT_EQ(zone(1).state.load(), std::uint64_t{header().epoch.load()} << 32 | 7);
  EXPECT_EQ(zone(1).head.load(), 2u);
  EXPECT_EQ(zone(1).slots.load(), 2u);
  EXPECT_EQ(map->generation(1), 7u);
  map->withdraw(1);
  EXPECT_EQ(zone(1).state.load(), 0u);
  EXPECT_FALSE(map->generation(1));
}

TEST_F(Shared, TakenOverAfterACrashShowsNothingOfBeforeAndNoStateTwice) {
  {
    auto map = SharedMap::lay_out(memory, kZones, kSlots);
    map->publish(1, 7, {2, 3, 2});
  }
  const std::uint64_t before = zone(1).state.load();
  auto map = SharedMap::lay_out(memory, kZones, kSlots);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(zone(1).state.load(), 0u);
  map->publish(1, 7, {2, 3, 2});
  EXPECT_NE(zone(1).state.load(), before);
}

TEST_F(Shared, RefusesMemoryLaidOutForOtherNumbers) {
  ASSERT_TRUE(SharedMap::lay_out(memory, kZones, kSlots).ok());
  EXPECT_FALSE(SharedMap::lay_out(memory.first(bytes - 1), kZones, kSlots).ok());
  reinterpret_cast<SharedHeader*>(block.get())->slots_at -= 4096;
  EXPECT_FALSE(SharedMap::lay_out(memory, kZones, kSlots).ok());
}

TEST_F(Shared, RefusesAMapOfMoreZonesThanThereIsRoomFor) {
  auto map = SharedMap::lay_out(memory, kZones, kSlots);
  EXPECT_EQ(map->begin_map(4).error().code, ErrorCode::kTooLarge);
}

}  // namespace
}  // namespace zonepack
