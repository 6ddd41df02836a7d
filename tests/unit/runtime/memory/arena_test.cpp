// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/arena.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace zonepack {
namespace {

TEST(Arena, CutsOneZeroedPageAlignedBlockIntoSlots) {
  Arena arena(3, 16384);
  EXPECT_EQ(arena.bytes(), 49152u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(arena.slot(0).data()) % 4096, 0u);
  EXPECT_EQ(arena.slot(2).data(), arena.slot(0).data() + 32768);
  EXPECT_EQ(arena.slot(1).size(), 16384u);
  for (SlotIndex i = 0; i < 3; ++i) {
    const auto slot = arena.slot(i);
    EXPECT_TRUE(
        std::all_of(slot.begin(), slot.end(), [](std::byte b) { return b == std::byte{0}; }));
  }
}

TEST(Arena, OfNoSlotsHoldsNothing) { EXPECT_EQ(Arena(0, 16384).bytes(), 0u); }

TEST(ArenaDeathTest, RefusesASlotPastItsEnd) {
  Arena arena(2, 64);
  EXPECT_DEATH(arena.slot(2), "index < slots_");
}

}  // namespace
}  // namespace zonepack
