// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/zone_keeper.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "runtime/run/maps/modelled_loader.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// Zones of 4 slots each among 8 slots; a load takes 1 s, in chunks of 0.25 s.
class Keeper : public testing::Test, public EventSink, public ZoneFiller {
 protected:
  void SetUp() override { make(8, {}); }

  void make(std::uint32_t slots, std::vector<ZoneId> pins) {
    pinned = std::move(pins);
    memory = std::make_unique<Residency>(
        needs.size(), ResidencyLimits{.budget = ByteCount{slots} * 100,
                                      .slot_bytes = 100,
                                      .largest_pair = {.slots = 4, .signatures = 4}});
    for (const ZoneId zone : pinned) ASSERT_TRUE(memory->pin(zone, needs[zone]).ok());
    loader = std::make_unique<ModelledLoader>(slots, work,
                                              LoadRates{.storage = 1000, .decode = 1000}, this);
    keeper = std::make_unique<ZoneKeeper>(*memory, *loader, events, needs, pinned);
  }

  void on_event(const Event& event) noexcept override {
    if (event.kind == EventKind::kZoneWanted || event.kind == EventKind::kZoneUnwanted) return;
    log.push_back(std::string(to_string(event.kind)) + " " + std::to_string(event.zone));
  }

  Result<void> fill(ZoneId zone, std::span<const SlotIndex>) override {
    if (zone == broken) return ErrorCode::kBadChecksum;
    return {};
  }

  void step(std::vector<ZoneId> wanted, std::size_t urgent = 16, std::int64_t dt = kSecond) {
    now += dt;
    loader->advance_to(now);
    std::vector<LoadResult> loads;
    while (const auto load = loader->poll()) loads.push_back(*load);
    keeper->collect(now, loads);
    keeper->keep(now, wanted, urgent);
  }

  using Log = std::vector<std::string>;
  Log taken() { return std::exchange(log, {}); }

  std::vector<ZoneNeed> needs = std::vector<ZoneNeed>(6, ZoneNeed{.slots = 4, .signatures = 4});
  std::vector<LoadWork> work = std::vector<LoadWork>(6, LoadWork{.stored_bytes = 1000});
  std::vector<ZoneId> pinned;
  ZoneId broken = kNoZone;
  EventStamper events{*this};
  std::unique_ptr<Residency> memory;
  std::unique_ptr<ModelledLoader> loader;
  std::unique_ptr<ZoneKeeper> keeper;
  std::int64_t now = 0;
  Log log;
};

// Of zones with 4 slots each, two fit.
TEST_F(Keeper, WhatIsOnlyUsefulTakesTheRoomThatIsLeftAndBlocksNothing) {
  const auto keep = [&](std::vector<ZoneId> wanted, std::size_t needed) {
    now += kSecond;
    loader->advance_to(now);
    std::vector<LoadResult> loads;
    while (const auto load = loader->poll()) loads.push_back(*load);
    keeper->collect(now, loads);
    keeper->keep(now, wanted, 1, needed);
  };
  keep({0, 1, 2}, 1);
  keep({0, 1, 2}, 1);
  EXPECT_EQ(taken(), (Log{"load_started 0", "load_done 0", "load_started 1"}));
  keep({0, 1, 2}, 1);
  EXPECT_EQ(taken(), Log{"load_done 1"});  // 2 does not fit, and is not said to
  EXPECT_FALSE(keeper->blocked());
  // A nearer one takes the room of one that is farther.
  keep({0, 3, 1}, 1);
  EXPECT_EQ(taken(), (Log{"evicted 1", "load_started 3"}));
  // What is needed does not wait for a load that is only useful.
  keeper->keep(now, std::vector<ZoneId>{0, 4, 3}, 1, 2);
  EXPECT_EQ(taken(), Log{"load_cancelled 3"});
}

TEST_F(Keeper, LoadsWhatIsWantedOneAfterTheOtherMostUrgentFirst) {
  step({0, 1});
  EXPECT_EQ(taken(), Log{"load_started 0"});
  step({0, 1});
  EXPECT_EQ(taken(), (Log{"load_done 0", "load_started 1"}));
  step({0, 1});
  EXPECT_EQ(taken(), Log{"load_done 1"});
  EXPECT_FALSE(keeper->blocked());
}

TEST_F(Keeper, UnloadsTheZoneLeftLongestAgo) {
  step({0});
  step({0, 1});
  step({1});
  taken();
  step({1, 2});
  EXPECT_EQ(taken(), (Log{"evicted 0", "load_started 2"}));
}

TEST_F(Keeper, CancelsALoadThatIsNoLongerWanted) {
  step({0});
  step({0, 1});
  taken();
  step({0}, 16, kSecond / 10);
  EXPECT_EQ(taken(), Log{"load_cancelled 1"});
  EXPECT_EQ(memory->charged(), 800u);  // until the loader gives the slots back
  step({0}, 16, kSecond / 4);
  EXPECT_EQ(taken(), Log{"load_given_up 1"});
  EXPECT_EQ(memory->charged(), 400u);
}

TEST_F(Keeper, CancelsALoadThatKeepsTheOwnZoneWaiting) {
  step({0});
  step({0, 1});
  taken();
  step({2, 1, 0}, 16, kSecond / 10);
  EXPECT_EQ(taken(), Log{"load_cancelled 1"});
  step({2, 1, 0}, 16, kSecond / 4);
  EXPECT_EQ(taken(), (Log{"load_given_up 1", "load_started 2"}));
}

TEST_F(Keeper, BlocksWhenWhatMustStayLeavesNoRoomAndSaysSoOnce) {
  needs[2] = {6, 6};
  step({0});
  taken();
  step({0, 2});
  step({0, 2});
  EXPECT_EQ(taken(), (Log{"load_done 0", "blocked 2"}));
  EXPECT_TRUE(keeper->blocked());
  EXPECT_TRUE(memory->resident(0));
  step({2});
  EXPECT_EQ(taken(), (Log{"evicted 0", "load_started 2", "unblocked 2"}));
}

TEST_F(Keeper, AnUrgentZoneTakesTheRoomOfALessUrgentOne) {
  step({0});
  step({0, 1});
  step({0, 1});
  taken();
  step({0, 2, 1});
  EXPECT_EQ(taken(), (Log{"evicted 1", "load_started 2"}));
  step({0, 2, 1});
  EXPECT_EQ(taken(), (Log{"load_done 2", "blocked 1"}));
}

TEST_F(Keeper, AZoneThatIsOnlyPossibleTakesNoOtherZonesRoom) {
  step({0});
  step({0, 1});
  step({0, 1});
  taken();
  step({0, 2, 1}, 1);
  EXPECT_EQ(taken(), Log{"blocked 2"});
  EXPECT_TRUE(memory->resident(1));
}

TEST_F(Keeper, ADamagedZoneCostsOnlyItselfAndIsTriedAgainLaterAndLater) {
  broken = 0;
  step({0, 1});
  step({0, 1});  // failed: retried a second later; zone 1 goes first
  EXPECT_EQ(taken(), (Log{"load_started 0", "load_failed 0", "load_started 1"}));
  step({0, 1});
  EXPECT_EQ(taken(), (Log{"load_done 1", "load_started 0"}));
  step({0, 1});  // failed again: two seconds
  step({0, 1});
  EXPECT_EQ(taken(), Log{"load_failed 0"});
  broken = kNoZone;
  step({0, 1});
  step({0, 1});
  EXPECT_EQ(taken(), (Log{"load_started 0", "load_done 0"}));
}

TEST_F(Keeper, LoadsPinnedZonesAndNeverUnloadsThem) {
  make(8, {5});
  step({0});
  step({0});
  step({0});
  EXPECT_EQ(taken(), (Log{"load_started 0", "load_done 0", "load_started 5", "load_done 5"}));
  step({1});
  EXPECT_EQ(taken(), (Log{"evicted 0", "load_started 1"}));
}

TEST_F(Keeper, HoldsTheLimitUnderRandomWishes) {
  std::mt19937 random(3);
  for (int round = 0; round < 2000; ++round) {
    std::vector<ZoneId> wanted;
    for (ZoneId zone = 0; zone < 6; ++zone) {
      if (random() % 3 == 0) wanted.push_back(zone);
    }
    std::shuffle(wanted.begin(), wanted.end(), random);
    broken = random() % 4 == 0 ? static_cast<ZoneId>(random() % 6) : kNoZone;
    step(wanted, random() % 4, static_cast<std::int64_t>(random() % 700) * 1'000'000);
    std::uint64_t held = 0;
    for (ZoneId zone = 0; zone < 6; ++zone) {
      if (memory->state(zone) != ZoneState::kAbsent) held += needs[zone].slots;
    }
    ASSERT_LE(held, 8u);
    ASSERT_EQ(loader->pool().free_count(), 8 - held);
  }
  EXPECT_GT(memory->counters().zones_unloaded, 20u);
}

// Likely zones: of 4 slots each two fit; along the way 1, 2, 3 the sooner is worth more.
class LikelyZones : public Keeper {
 protected:
  void keep(std::vector<ZoneId> wanted, std::size_t useful, bool sure,
            std::size_t due = ZoneKeeper::kMaxWanted) {
    now += kSecond;
    loader->advance_to(now);
    std::vector<LoadResult> loads;
    while (const auto load = loader->poll()) loads.push_back(*load);
    keeper->collect(now, loads);
    keeper->keep(now, {wanted, useful, useful, useful, true, &foresight, sure, due});
  }
  void hold(ZoneId zone) {
    step({zone});
    step({zone});
    taken();
  }
  Foresight foresight;
};

TEST_F(LikelyZones, TakeTheRoomOfWhatIsWorthLess) {
  hold(5);
  hold(0);
  foresight.follow(std::vector<ZoneId>{1, 2, 3}, kNoZone, 0, nullptr);
  keep({0, 1, 2, 3}, 1, true);
  EXPECT_EQ(taken(), (Log{"evicted 5", "load_started 1"}));  // nobody comes to 5
  keep({0, 1, 2, 3}, 1, true);
  keep({0, 1, 2, 3}, 1, true);
  EXPECT_EQ(taken(), Log{"load_done 1"});  // 1 comes before 2
  EXPECT_FALSE(keeper->blocked());
}

// The way is 1, 3, 2; held are 3, which is colder, and 2, which comes later.
TEST_F(LikelyZones, TakeTheRoomOfWhatIsWorthLeastAlthoughAnotherIsColder) {
  make(12, {});
  hold(3);
  hold(2);
  hold(0);
  foresight.follow(std::vector<ZoneId>{1, 3, 2}, kNoZone, 0, nullptr);
  keep({0, 1, 3, 2}, 1, true);
  EXPECT_EQ(taken(), (Log{"evicted 2", "load_started 1"}));
}

// 1 is due, 2 is not: 2 takes free room, and leaves 5 where it is.
TEST_F(LikelyZones, TakeFreeRoomOnlyUntilTheyAreDue) {
  make(12, {});
  hold(5);
  hold(0);
  foresight.follow(std::vector<ZoneId>{1, 2}, kNoZone, 0, nullptr);
  const std::vector<ZoneId> wanted{0, 1, 2};
  for (int cycle = 0; cycle < 3; ++cycle) {
    keep(wanted, 1, true, 2);
  }
  EXPECT_EQ(taken(), (Log{"load_started 1", "load_done 1"}));
  keep(wanted, 1, true, 3);
  EXPECT_EQ(taken(), (Log{"evicted 5", "load_started 2"}));
}

TEST_F(LikelyZones, AreGivenUpWhenTheyDoNotCome) {
  hold(0);
  foresight.follow(std::vector<ZoneId>{1}, kNoZone, 0, nullptr);
  keep({0, 1}, 1, false);
  EXPECT_EQ(taken(), Log{"load_started 1"});
  keeper->keep(now, {std::vector<ZoneId>{0}, 1, 1, 1, true, &foresight, false});
  EXPECT_EQ(taken(), Log{"load_cancelled 1"});
}

TEST_F(LikelyZones, GiveWayToWhatIsNeededUnlessTheyAreTheWayAhead) {
  hold(0);
  foresight.follow(std::vector<ZoneId>{1}, kNoZone, 0, nullptr);
  keep({0, 1}, 1, false);
  EXPECT_EQ(taken(), Log{"load_started 1"});
  keeper->keep(now, {std::vector<ZoneId>{0, 2, 1}, 2, 2, 2, true, &foresight, false});
  EXPECT_EQ(taken(), Log{"load_cancelled 1"});
  make(8, {});
  hold(0);
  keep({0, 1}, 1, true);
  keeper->keep(now, {std::vector<ZoneId>{0, 2, 1}, 2, 2, 2, true, &foresight, true});
  EXPECT_EQ(taken(), Log{"load_started 1"});
}

TEST_F(LikelyZones, ProtectNothingFromWhatIsNeeded) {
  hold(1);
  hold(0);
  foresight.follow(std::vector<ZoneId>{1}, kNoZone, 0, nullptr);
  keep({0, 2, 1}, 2, true);
  EXPECT_EQ(taken(), (Log{"evicted 1", "load_started 2"}));
}

// 1 comes before 2. It and the robot's own zone fill the memory, so that 2 would be evicted again.
TEST_F(LikelyZones, AreNotLoadedWhereTheyCouldNotStayUntilTheyCome) {
  hold(0);
  foresight.follow(std::vector<ZoneId>{1, 2}, kNoZone, 0, nullptr);
  keep({0, 2}, 1, false);
  EXPECT_EQ(taken(), Log{});
  keep({0, 2}, 1, true);
  EXPECT_EQ(taken(), Log{"load_started 2"}) << "but along a route";
  make(12, {});
  hold(0);
  keep({0, 2}, 1, false);
  EXPECT_EQ(taken(), Log{"load_started 2"}) << "there is room for all three";
}

TEST_F(LikelyZones, EvictNothingWhileFrozen) {
  hold(5);
  hold(0);
  memory->freeze(true);
  foresight.follow(std::vector<ZoneId>{1}, kNoZone, 0, nullptr);
  keep({0, 1}, 1, true);
  EXPECT_EQ(taken(), Log{});
}

}  // namespace
}  // namespace zonepack
