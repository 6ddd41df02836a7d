// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/transitions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "runtime/pack_format/file/transitions_bytes.hpp"
#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// A crossing: h (x 0 to 4, y 0 to 4) with a to the west, b to the north, c to the east, d to the
// south, and e beyond c.
constexpr ZoneId kA = 0, kB = 1, kC = 2, kD = 3, kE = 4, kH = 5;

ZoneGraph crossing() {
  const GraphPortal portals[] = {{kA, kH, {{0, 1}, {0, 3}}},
                                 {kB, kH, {{1, 4}, {3, 4}}},
                                 {kC, kH, {{4, 1}, {4, 3}}},
                                 {kD, kH, {{1, 0}, {3, 0}}},
                                 {kC, kE, {{8, 1}, {8, 3}}}};
  return ZoneGraph({{"a", box(-4, 0, 0, 4)},
                    {"b", box(0, 4, 4, 8)},
                    {"c", box(4, 0, 8, 4)},
                    {"d", box(0, -4, 4, 0)},
                    {"e", box(8, 0, 12, 4)},
                    {"h", box(0, 0, 4, 4)}},
                   portals);
}

class TransitionsTest : public testing::Test {
 protected:
  const ZoneGraph graph = crossing();
  Transitions table{graph};

  std::vector<ZoneId> order(ZoneId before, ZoneId now) const {
    std::vector<ZoneId> zones;
    for (const Successor& next : table.after(before, now)) zones.push_back(next.zone);
    return zones;
  }
  float share(ZoneId before, ZoneId now, ZoneId next) const {
    for (const Successor& one : table.after(before, now)) {
      if (one.zone == next) return one.share;
    }
    return 0;
  }
  float seconds(ZoneId before, ZoneId now, ZoneId next) const {
    for (const Successor& one : table.after(before, now)) {
      if (one.zone == next) return one.seconds;
    }
    return 0;
  }
};

using Zones = std::vector<ZoneId>;

TEST_F(TransitionsTest, GoesStraightOnWhereNothingWasCounted) {
  // From a: c is straight on (weight 3); b and d are at 45 degrees, 2 + 2 m off: 1 + 2 * 0.7071 =
  // 2.4142; a is back (0.25). The sum is 3 + 2 * 2.4142 + 0.25 = 8.0784.
  EXPECT_EQ(order(kA, kH), (Zones{kC, kB, kD, kA}));
  EXPECT_FLOAT_EQ(share(kA, kH, kC), 3 / 8.0784273f);
  EXPECT_FLOAT_EQ(share(kA, kH, kB), 2.4142136f / 8.0784273f);
  EXPECT_FLOAT_EQ(share(kA, kH, kA), 0.25f / 8.0784273f);
  // 4 m at 0.5 m/s.
  EXPECT_FLOAT_EQ(seconds(kA, kH, kC), 8);
}

TEST_F(TransitionsTest, TakesAllPortalsAlikeWhenItIsNotKnownWhereFrom) {
  EXPECT_EQ(order(kNoZone, kH), (Zones{kA, kB, kC, kD}));
  EXPECT_FLOAT_EQ(share(kNoZone, kH, kD), 0.25f);
  EXPECT_EQ(order(kNoZone, kNoZone), Zones{});
}

TEST_F(TransitionsTest, CountsByTheZoneBeforeAndFallsBackToTheZoneAlone) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(table.learn(kA, kH, kD, 10 * kSecond_ns));
  // Of order 1: d has 3 of 3 + 0.5; geometry has the rest. Fading takes 1/64 of what was there:
  // after three drives 1 + 63/64 + (63/64)^2, in steps of 1/1024: 1024, 2032, 3025 (2032 - 31 +
  // 1024): 2.9541.
  const double counted = 3025.0 / 1024, all = counted + 0.5;
  const double first = (counted + 0.5 * 0.29884697) / all;
  EXPECT_NEAR(share(kA, kH, kD), (counted + 0.5 * first) / all, 1e-6);
  EXPECT_EQ(order(kA, kH).front(), kD);
  // From b, nothing was counted: order 1 alone, over b's geometry (d is straight on).
  EXPECT_NEAR(share(kB, kH, kD), (counted + 0.5 * 3 / 8.0784273) / all, 1e-6);
  // The habit is one of those who come from a: from b another one wins.
  for (int i = 0; i < 3; ++i) table.learn(kB, kH, kA, kSecond_ns);
  EXPECT_EQ(order(kB, kH).front(), kA);
  EXPECT_EQ(order(kA, kH).front(), kD);
}

TEST_F(TransitionsTest, SharesAddUpToOne) {
  table.learn(kA, kH, kD, kSecond_ns);
  table.learn(kB, kH, kC, kSecond_ns);
  for (const ZoneId before : {kA, kB, kC, kD, kNoZone}) {
    float sum = 0;
    for (const Successor& next : table.after(before, kH)) sum += next.share;
    EXPECT_NEAR(sum, 1, 1e-6) << before;
  }
}

TEST_F(TransitionsTest, UnlearnsAHabitThatChanged) {
  for (int i = 0; i < 500; ++i) table.learn(kA, kH, kD, kSecond_ns);
  for (int i = 0; i < 50; ++i) table.learn(kA, kH, kB, kSecond_ns);
  // 64 counts of d fade by (63/64)^50 to 29; b has 35.
  EXPECT_EQ(order(kA, kH).front(), kB);
  EXPECT_NEAR(share(kA, kH, kB), 0.55, 0.02);
}

TEST_F(TransitionsTest, ExpectsTheMeanOfTheStays) {
  table.learn(kA, kH, kD, 10 * kSecond_ns);
  table.learn(kA, kH, kD, 20 * kSecond_ns);  // 10 + (20 - 10) / 2
  EXPECT_FLOAT_EQ(seconds(kA, kH, kD), 15);
  EXPECT_NEAR(table.seconds_in(kA, kH), 13.5, 1.5);  // the rest is geometry, at 5.7 and 8 s
}

TEST_F(TransitionsTest, CountsNothingThroughWalls) {
  EXPECT_FALSE(table.learn(kH, kA, kE, kSecond_ns));
  EXPECT_FALSE(table.learn(kH, 77, kE, kSecond_ns));
  EXPECT_TRUE(table.contexts().empty());
}

TEST_F(TransitionsTest, TakesWhatIsCharged) {
  // h has four portals: five contexts of four successors; c two: three of two; a, b, d and e one:
  // two of one.
  EXPECT_EQ(table.capacity(), 16u);
  const MapCosts costs{.zone_slots = std::vector<std::uint32_t>(6, 1),
                       .neighbours = {{kA, kH}, {kB, kH}, {kC, kH}, {kD, kH}, {kC, kE}}};
  EXPECT_EQ(transitions_bytes(costs), 16u * 9 + (5 * 4 + 3 * 2 + 4 * 2 * 1) * 8u);
  EXPECT_EQ(table.memory_bytes(), transitions_bytes(costs));
  for (const ZoneId before : {kNoZone, kA, kB, kC, kD}) {
    for (const ZoneId next : {kA, kB, kC, kD}) table.learn(before, kH, next, kSecond_ns);
  }
  for (const ZoneId before : {kH, kE}) {
    for (const ZoneId next : {kH, kE}) table.learn(before, kC, next, kSecond_ns);
  }
  for (const ZoneId room : {kA, kB, kD}) table.learn(kH, room, kH, kSecond_ns);
  table.learn(kC, kE, kC, kSecond_ns);
  EXPECT_EQ(table.contexts().size(), 16u);
  EXPECT_EQ(table.memory_bytes(), transitions_bytes(costs)) << "it grew";
}

// Rooms along a corridor, `rooms` of them from 1 on; the corridor is 0.
ZoneGraph corridor(std::uint32_t rooms) {
  std::vector<GraphZone> zones{{"a", box(0, 0, 4.0 * rooms, 2)}};
  std::vector<GraphPortal> portals;
  for (std::uint32_t i = 1; i <= rooms; ++i) {
    std::string name = std::to_string(i);
    name.insert(0, 5 - name.size(), '0');
    const double x = 4.0 * (i - 1);
    zones.push_back({"r" + name, box(x, 2, x + 4, 6)});
    portals.push_back({0, i, {{x + 1, 2}, {x + 2, 2}}});
  }
  return ZoneGraph(std::move(zones), portals);
}

TEST(TransitionsOfACorridor, DropsItsRarestSuccessorForANewOne) {
  const ZoneGraph long_one = corridor(9);
  Transitions habits(long_one);
  habits.learn(kNoZone, 0, 1, kSecond_ns);
  for (ZoneId room = 1; room <= 8; ++room) {
    for (ZoneId times = 0; times < (room == 3 || room == 6 ? 1 : 2); ++times) {
      habits.learn(kNoZone, 0, room, room * kSecond_ns);
    }
  }
  habits.learn(kNoZone, 0, 9, kSecond_ns);
  const auto contexts = habits.contexts();
  ASSERT_EQ(contexts.size(), 1u);
  std::vector<ZoneId> zones;
  for (const auto& entry : contexts[0].next) zones.push_back(entry.zone);
  EXPECT_EQ(zones, (std::vector<ZoneId>{1, 2, 9, 4, 5, 6, 7, 8}));
  EXPECT_EQ(contexts[0].next[7].milliseconds, 8000u);
  EXPECT_EQ(contexts[0].next[2].count, Transitions::kOne);
  EXPECT_EQ(contexts[0].next[2].seen, habits.steps());
  EXPECT_EQ(contexts[0].next[5].seen, habits.steps() - 5);  // 6, then 7, 7, 8, 8, 9
}

TEST(TransitionsOfACorridor, ForgetsTheContextNotSeenForLongestWhenItIsFull) {
  // 8 corridors would be 8 * (257 + 256 * 2) contexts; a ring of 700 rooms has 2,100.
  constexpr std::uint32_t kRooms = 700;
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  for (std::uint32_t i = 0; i < kRooms; ++i) {
    zones.push_back({std::to_string(1000 + i), box(4.0 * i, 0, 4.0 * i + 4, 4)});
    portals.push_back({i, (i + 1) % kRooms, {{4.0 * i + 4, 1}, {4.0 * i + 4, 3}}});
  }
  const ZoneGraph ring(std::move(zones), portals);
  Transitions habits(ring);
  ASSERT_EQ(habits.capacity(), Transitions::kMostContexts);
  const ByteCount memory = habits.memory_bytes();
  EXPECT_EQ(memory, 2048 * 9u + std::min<ByteCount>(2048 * 8, 3 * 700 * 2) * 8u);
  const auto go = [&](std::uint32_t i, std::uint32_t by) {
    return habits.learn((i + kRooms - by) % kRooms, i, (i + by) % kRooms, kSecond_ns);
  };
  // Once round one way takes 1,400 contexts, the other way 700 more: 52 too many.
  for (std::uint32_t i = 0; i < kRooms; ++i) ASSERT_TRUE(go(i, 1));
  for (std::uint32_t i = 0; i < kRooms; ++i) ASSERT_TRUE(go(i, kRooms - 1));
  EXPECT_EQ(habits.contexts().size(), 2048u);
  EXPECT_EQ(habits.memory_bytes(), memory);
  std::vector<ZoneId> gone;
  const auto kept = habits.contexts();
  for (ZoneId i = 0; i < kRooms; ++i) {
    const ZoneId before = (i + kRooms - 1) % kRooms;
    const bool here = std::ranges::any_of(
        kept, [&](const auto& context) { return context.before == before && context.now == i; });
    if (!here) gone.push_back(i);
  }
  ASSERT_EQ(gone.size(), 52u);
  EXPECT_EQ(gone.back(), 51u) << "the first that were counted";
  // What came after them in the table is whole.
  for (ZoneId i = 60; i < 70; ++i) {
    const Successors next = habits.after(i - 1, i);
    EXPECT_EQ(next[0].zone, i + 1) << i;
  }
}

TEST_F(TransitionsTest, KeepsCountsTimesAndAgesToTheBit) {
  Transitions::Context context;
  context.before = kA;
  context.now = kH;
  context.next[0] = {kD, Transitions::kMostCount, Transitions::kMostMilliseconds, 999};
  context.next[1] = {kC, 1, 0, 1000};
  context.next[2] = {kB, 65535, 1, 1000 - Transitions::kOldest};
  table.continue_steps(1000);
  ASSERT_TRUE(table.restore(context));
  const auto contexts = table.contexts();
  ASSERT_EQ(contexts.size(), 1u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(contexts[0].next[i].zone, context.next[i].zone) << i;
    EXPECT_EQ(contexts[0].next[i].count, context.next[i].count) << i;
    EXPECT_EQ(contexts[0].next[i].milliseconds, context.next[i].milliseconds) << i;
    EXPECT_EQ(contexts[0].next[i].seen, context.next[i].seen) << i;
  }
  EXPECT_EQ(contexts[0].next[3].zone, kNoZone);
}

TEST_F(TransitionsTest, RestoresWhatItHeld) {
  table.learn(kA, kH, kD, 10 * kSecond_ns);
  table.learn(kH, kD, kH, 5 * kSecond_ns);
  Transitions other(graph);
  const auto contexts = table.contexts();
  for (const auto& context : contexts) EXPECT_TRUE(other.restore(context));
  EXPECT_EQ(other.contexts().size(), 4u);
  for (const ZoneId before : {kA, kB}) {
    const Successors is = other.after(before, kH), was = table.after(before, kH);
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t i = 0; i < is.size(); ++i) {
      EXPECT_EQ(is[i].zone, was[i].zone);
      EXPECT_EQ(is[i].share, was[i].share);
      EXPECT_EQ(is[i].seconds, was[i].seconds);
    }
  }
  EXPECT_FALSE(other.restore(contexts.front())) << "is there already";
}

TEST_F(TransitionsTest, RestoresNothingThatBreaksARule) {
  Transitions::Context good;
  good.before = kA;
  good.now = kH;
  good.next[0] = {kD, Transitions::kOne, 1000, 1};
  auto bad = good;
  bad.next[0].count = 0;
  EXPECT_FALSE(table.restore(bad));
  bad = good;
  bad.next[0].count = Transitions::kMostCount + 1;
  EXPECT_FALSE(table.restore(bad));
  bad = good;
  bad.next[0].zone = kE;  // no neighbour
  EXPECT_FALSE(table.restore(bad));
  bad = good;
  bad.next[1] = bad.next[0];  // twice
  EXPECT_FALSE(table.restore(bad));
  bad = good;
  bad.before = kE;  // no way leads from e to h
  EXPECT_FALSE(table.restore(bad));
  bad = good;
  bad.next[0].zone = kNoZone;  // empty
  EXPECT_FALSE(table.restore(bad));
  EXPECT_TRUE(table.restore(good));
}

TEST_F(TransitionsTest, ListsAtMostEightSuccessorsTheLikeliestFirst) {
  Successors list;
  for (ZoneId zone = 0; zone < 12; ++zone) {
    list.add({zone, static_cast<float>(zone % 4), 1});
  }
  ASSERT_EQ(list.size(), 8u);
  std::vector<ZoneId> zones;
  for (const Successor& one : list) zones.push_back(one.zone);
  EXPECT_EQ(zones, (Zones{3, 7, 11, 2, 6, 10, 1, 5}));
}

TEST_F(TransitionsTest, FollowsTheRobotFromZoneToZone) {
  ZoneSteps steps;
  EXPECT_EQ(steps.enter(graph, kA, 1 * kSecond_ns), nullptr);
  EXPECT_EQ(steps.enter(graph, kA, 2 * kSecond_ns), nullptr);
  const ZoneSteps::Step* step = steps.enter(graph, kH, 4 * kSecond_ns);
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->before, kNoZone);
  EXPECT_EQ(step->now, kA);
  EXPECT_EQ(step->next, kH);
  EXPECT_EQ(step->stay_ns, 3 * kSecond_ns);
  step = steps.enter(graph, kC, 5 * kSecond_ns);
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->before, kA);
  // Carried through a wall: no step, and what came before is forgotten.
  EXPECT_EQ(steps.enter(graph, kA, 6 * kSecond_ns), nullptr);
  EXPECT_EQ(steps.before(), kNoZone);
  EXPECT_EQ(steps.now(), kA);
  EXPECT_EQ(steps.enter(graph, kNoZone, 7 * kSecond_ns), nullptr);
  EXPECT_EQ(steps.enter(graph, kH, 8 * kSecond_ns), nullptr);
}

}  // namespace
}  // namespace zonepack
