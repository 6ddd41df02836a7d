// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/slot_pool.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace zonepack {
namespace {

std::vector<SlotIndex> slots_of(const SlotPool& pool, const SlotChain& chain) {
  std::vector<SlotIndex> slots;
  for (SlotIndex s = chain.head; s != kNoSlot; s = pool.next(s)) slots.push_back(s);
  return slots;
}

TEST(SlotPool, HandsOutEverySlotOnceAndThenNone) {
  SlotPool pool(3);
  SlotChain chain;
  EXPECT_TRUE(pool.take_one(chain));
  EXPECT_TRUE(pool.take(2, chain));
  EXPECT_EQ(slots_of(pool, chain), (std::vector<SlotIndex>{0, 1, 2}));
  EXPECT_EQ(chain.count, 3u);
  EXPECT_EQ(pool.free_count(), 0u);
  EXPECT_FALSE(pool.take_one(chain));
  EXPECT_EQ(chain.count, 3u);
}

TEST(SlotPool, TakesAllThatIsAskedForOrNothing) {
  SlotPool pool(3);
  SlotChain chain;
  EXPECT_FALSE(pool.take(4, chain));
  EXPECT_EQ(chain.count, 0u);
  EXPECT_EQ(pool.free_count(), 3u);
}

TEST(SlotPool, ReusesTheSlotGivenBackFirstLast) {
  SlotPool pool(4);
  SlotChain a, b;
  ASSERT_TRUE(pool.take(2, a));  // 0 1
  ASSERT_TRUE(pool.take(1, b));  // 2
  pool.give_back(b);             // free: 3 2
  pool.give_back(a);             // free: 3 2 0 1
  EXPECT_EQ(a.count, 0u);
  EXPECT_EQ(a.head, kNoSlot);
  SlotChain all;
  ASSERT_TRUE(pool.take(4, all));
  EXPECT_EQ(slots_of(pool, all), (std::vector<SlotIndex>{3, 2, 0, 1}));
}

TEST(SlotPool, GivingBackNothingChangesNothing) {
  SlotPool pool(1);
  SlotChain none;
  pool.give_back(none);
  EXPECT_EQ(pool.free_count(), 1u);
}

TEST(SlotPool, KeepsItsLinksWhereOthersCanFollowThem) {
  std::vector<SlotIndex> links(3);
  SlotPool pool(links);
  SlotChain chain;
  ASSERT_TRUE(pool.take(2, chain));
  EXPECT_EQ(links[chain.head], chain.tail);
  EXPECT_EQ(links[chain.tail], kNoSlot);
}

TEST(SlotPool, OfNoSlotsIsEmpty) {
  SlotPool pool(0);
  SlotChain chain;
  EXPECT_FALSE(pool.take_one(chain));
  EXPECT_TRUE(pool.take(0, chain));
  EXPECT_EQ(SlotPool::table_bytes(1000), 4000u);
}

}  // namespace
}  // namespace zonepack
