// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/residency.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace zonepack {
namespace {

constexpr ByteCount kSlotSize = 100;

// A budget of 1000 bytes: 200 fixed, 8 slots of 100.
ResidencyLimits limits_of(std::uint64_t max_signatures = 0) {
  return {.budget = 1000,
          .fixed = 200,
          .slot_bytes = kSlotSize,
          .max_signatures = max_signatures,
          .largest_pair = {.slots = 4, .signatures = 40},
          .lease_ns = 50};
}

class Memory : public testing::Test {
 protected:
  std::vector<ZoneId> evicted;

  Result<std::size_t> admit(Residency& memory, ZoneId zone, ZoneNeed need,
                            Purpose purpose = Purpose::kApproach) {
    evicted.clear();
    return memory.admit(zone, need, purpose,
                        [this](const Eviction& eviction) { evicted.push_back(eviction.zone); });
  }

  // Admits a zone and lets its load finish at once.
  void load(Residency& memory, ZoneId zone, ZoneNeed need) {
    ASSERT_TRUE(admit(memory, zone, need).ok());
    memory.complete(zone, memory.generation(zone), {zone, zone, need.slots});
  }
};

TEST_F(Memory, ChargesAZoneFromAdmissionOnAndNotOnlyOnceItIsLoaded) {
  Residency memory(4, limits_of());
  EXPECT_EQ(memory.slot_count(), 8u);
  EXPECT_EQ(memory.charged(), 200u);
  ASSERT_TRUE(admit(memory, 1, {.slots = 3, .signatures = 30}).ok());
  EXPECT_EQ(memory.state(1), ZoneState::kFilling);
  EXPECT_EQ(memory.charged(), 500u);
  EXPECT_EQ(memory.resident_sum(), (NeedSum{.slots = 0, .signatures = 0}));
  memory.complete(1, 1, {0, 2, 3});
  EXPECT_TRUE(memory.resident(1));
  EXPECT_EQ(memory.charged(), 500u);
  EXPECT_EQ(memory.resident_sum(), (NeedSum{.slots = 3, .signatures = 30}));
  EXPECT_EQ(memory.counters().signatures_loaded, 30u);
}

TEST_F(Memory, EvictsTheLeastRecentlyUsedZonesUntilTheNewOneFits) {
  Residency memory(4, limits_of());
  load(memory, 0, {.slots = 3, .signatures = 30});
  load(memory, 1, {.slots = 3, .signatures = 30});
  load(memory, 2, {.slots = 2, .signatures = 20});
  memory.touch(0);  // now 1 is the coldest, then 2
  const auto evictions = admit(memory, 3, {.slots = 4, .signatures = 40});
  ASSERT_TRUE(evictions.ok());
  EXPECT_EQ(*evictions, 2u);  // 1 gives 3 slots, 2 gives 2: 5 >= 4
  EXPECT_EQ(evicted, (std::vector<ZoneId>{1, 2}));
  EXPECT_EQ(memory.charged(), 200u + 700u);
  EXPECT_EQ(memory.counters().zones_unloaded, 2u);
  EXPECT_EQ(memory.counters().signatures_unloaded, 50u);
}

TEST_F(Memory, RefusesAZoneLargerThanTheBudget) {
  Residency memory(2, limits_of());
  load(memory, 0, {.slots = 2, .signatures = 20});
  EXPECT_EQ(admit(memory, 1, {.slots = 9, .signatures = 1}).error(),
            (Error{ErrorCode::kTooLarge, 9}));
  EXPECT_TRUE(memory.resident(0));
}

TEST_F(Memory, EvictsNothingForAZoneThatWouldNotFitAnyway) {
  Residency memory(3, limits_of());
  load(memory, 0, {.slots = 5, .signatures = 50});
  load(memory, 1, {.slots = 2, .signatures = 20});
  memory.protect(0);
  // Free 1, evictable 2: a zone of 4 does not fit besides the protected one.
  EXPECT_EQ(admit(memory, 2, {.slots = 4, .signatures = 40}).error().code, ErrorCode::kNoRoom);
  EXPECT_TRUE(evicted.empty());
  EXPECT_TRUE(memory.resident(1));
  EXPECT_EQ(memory.state(2), ZoneState::kAbsent);
  EXPECT_EQ(memory.charged(), 900u);
  memory.unprotect(0);
  EXPECT_TRUE(admit(memory, 2, {.slots = 4, .signatures = 40}).ok());
  EXPECT_EQ(evicted, (std::vector<ZoneId>{1, 0}));  // unprotecting made 0 the warmest
}

TEST_F(Memory, HoldsTheSignatureLimitEvenWhenSlotsAreFree) {
  Residency memory(3, limits_of(50));
  load(memory, 0, {.slots = 1, .signatures = 31});
  load(memory, 1, {.slots = 1, .signatures = 16});
  EXPECT_EQ(admit(memory, 2, {.slots = 1, .signatures = 51}).error().code, ErrorCode::kTooLarge);
  ASSERT_TRUE(admit(memory, 2, {.slots = 1, .signatures = 10}).ok());  // 31 + 16 + 10 = 57 > 50
  EXPECT_EQ(evicted, (std::vector<ZoneId>{0}));
  EXPECT_EQ(memory.signatures(), 26u);
}

TEST_F(Memory, NeverEvictsAZoneThatIsStillFilling) {
  Residency memory(2, limits_of());
  ASSERT_TRUE(admit(memory, 0, {.slots = 6, .signatures = 60}).ok());
  EXPECT_EQ(admit(memory, 1, {.slots = 4, .signatures = 40}).error().code, ErrorCode::kNoRoom);
}

TEST_F(Memory, KeepsACancelledLoadChargedUntilTheLoaderGivesItsSlotsBack) {
  Residency memory(2, limits_of());
  ASSERT_TRUE(admit(memory, 0, {.slots = 6, .signatures = 60}).ok());
  EXPECT_TRUE(memory.cancel(0));
  EXPECT_FALSE(memory.cancel(0));
  EXPECT_EQ(memory.state(0), ZoneState::kCancelling);
  EXPECT_EQ(memory.charged(), 800u);
  EXPECT_EQ(admit(memory, 0, {.slots = 6, .signatures = 60}).error().code, ErrorCode::kBusy);
  EXPECT_EQ(admit(memory, 1, {.slots = 4, .signatures = 40}).error().code, ErrorCode::kNoRoom);
  memory.give_up(0, 1);
  EXPECT_EQ(memory.charged(), 200u);
  EXPECT_EQ(memory.counters().loads_given_up, 1u);
  EXPECT_EQ(memory.counters().signatures_loaded, 0u);
  EXPECT_TRUE(admit(memory, 1, {.slots = 4, .signatures = 40}).ok());
}

TEST_F(Memory, KeepsALoadThatFinishedBeforeItsCancellationWasSeen) {
  Residency memory(1, limits_of());
  ASSERT_TRUE(admit(memory, 0, {.slots = 2, .signatures = 20}).ok());
  memory.cancel(0);
  memory.complete(0, 1, {0, 1, 2});
  EXPECT_TRUE(memory.resident(0));
  EXPECT_EQ(memory.counters().zones_loaded, 1u);
}

TEST_F(Memory, OpensANewGenerationWithEveryLoad) {
  Residency memory(2, limits_of());
  load(memory, 0, {.slots = 8, .signatures = 80});
  EXPECT_EQ(memory.generation(0), 1u);
  load(memory, 1, {.slots = 8, .signatures = 80});
  load(memory, 0, {.slots = 8, .signatures = 80});
  EXPECT_EQ(memory.generation(0), 2u);
}

TEST_F(Memory, HandsOutTheWholeChainOfAnEvictedZone) {
  Residency memory(2, limits_of());
  ASSERT_TRUE(admit(memory, 0, {.slots = 5, .signatures = 50}).ok());
  memory.complete(0, 1, {7, 3, 5});
  Eviction seen;
  ASSERT_TRUE(
      memory.admit(1, {8, 80}, Purpose::kApproach, [&](const Eviction& e) { seen = e; }).ok());
  EXPECT_EQ(seen.slots.head, 7u);
  EXPECT_EQ(seen.slots.tail, 3u);
  EXPECT_EQ(seen.slots.count, 5u);
  EXPECT_EQ(seen.need, (ZoneNeed{5, 50}));
  EXPECT_EQ(seen.generation, 1u);
}

TEST_F(Memory, PinsOnlyWhileTheLargestPairStillFits) {
  Residency memory(4, limits_of());  // 8 slots, largest pair 4
  EXPECT_TRUE(memory.pin(0, {3, 30}).ok());
  EXPECT_EQ(memory.pin(1, {2, 20}).error(), (Error{ErrorCode::kNoRoom, 2}));
  EXPECT_TRUE(memory.pin(1, {1, 10}).ok());
  load(memory, 0, {.slots = 3, .signatures = 30});
  EXPECT_EQ(admit(memory, 2, {.slots = 6, .signatures = 60}).error().code, ErrorCode::kNoRoom);
  memory.unpin(0);
  EXPECT_TRUE(admit(memory, 2, {.slots = 6, .signatures = 60}).ok());
  EXPECT_EQ(evicted, (std::vector<ZoneId>{0}));
}

TEST_F(Memory, ALeaseDelaysAnEvictionForAnApproachButNotForTheRobotsOwnZone) {
  Residency memory(2, limits_of());
  load(memory, 0, {.slots = 5, .signatures = 50});
  ASSERT_TRUE(memory.lease(0, 1000).ok());
  EXPECT_EQ(admit(memory, 1, {.slots = 5, .signatures = 50}).error().code, ErrorCode::kNoRoom);
  ASSERT_TRUE(admit(memory, 1, {.slots = 5, .signatures = 50}, Purpose::kOwnZone).ok());
  EXPECT_EQ(evicted, (std::vector<ZoneId>{0}));
  EXPECT_EQ(memory.counters().leases_revoked, 1u);
}

TEST_F(Memory, PrefersAnEvictableZoneToOneThatIsLeased) {
  Residency memory(3, limits_of());
  load(memory, 0, {.slots = 4, .signatures = 40});
  ASSERT_TRUE(memory.lease(0, 1000).ok());
  load(memory, 1, {.slots = 4, .signatures = 40});  // warmer, but without a reader
  ASSERT_TRUE(admit(memory, 2, {.slots = 4, .signatures = 40}, Purpose::kOwnZone).ok());
  EXPECT_EQ(evicted, (std::vector<ZoneId>{1}));
}

TEST_F(Memory, ALeaseRunsOutEvenWhileTheZoneIsProtected) {
  Residency memory(2, limits_of());  // leases last 50 ns
  load(memory, 0, {.slots = 5, .signatures = 50});
  ASSERT_TRUE(memory.lease(0, 1000).ok());
  memory.protect(0);
  memory.expire_leases(1049);
  memory.unprotect(0);
  EXPECT_EQ(admit(memory, 1, {.slots = 5, .signatures = 50}).error().code, ErrorCode::kNoRoom);
  memory.expire_leases(1050);
  EXPECT_TRUE(admit(memory, 1, {.slots = 5, .signatures = 50}).ok());
}

TEST_F(Memory, ReleasingARevokedLeaseDoesNotEndANewOne) {
  Residency memory(2, limits_of());
  load(memory, 0, {.slots = 5, .signatures = 50});
  const auto old = memory.lease(0, 1000);
  memory.expire_leases(2000);
  const auto young = memory.lease(0, 3000);
  memory.release(*old);
  EXPECT_EQ(admit(memory, 1, {.slots = 5, .signatures = 50}).error().code, ErrorCode::kNoRoom);
  memory.release(*young);
  EXPECT_TRUE(admit(memory, 1, {.slots = 5, .signatures = 50}).ok());
}

TEST_F(Memory, AZoneIsLeasedUntilItsLastReaderReleasesIt) {
  Residency memory(2, limits_of());
  load(memory, 0, {.slots = 5, .signatures = 50});
  const auto a = memory.lease(0, 1000);
  const auto b = memory.lease(0, 1000);
  memory.release(*a);
  EXPECT_EQ(admit(memory, 1, {.slots = 5, .signatures = 50}).error().code, ErrorCode::kNoRoom);
  memory.release(*b);
  EXPECT_TRUE(admit(memory, 1, {.slots = 5, .signatures = 50}).ok());
  EXPECT_EQ(memory.lease(0, 1000).error().code, ErrorCode::kNotFound);
}

TEST_F(Memory, CountsSlotsOfABudgetWithoutOverflow) {
  EXPECT_EQ(Residency::slots_within(1000, 200, 100), 8u);
  EXPECT_EQ(Residency::slots_within(199, 200, 100), 0u);
  EXPECT_EQ(Residency::slots_within(~ByteCount{0}, 0, 1), kNoSlot - 1);
}

// One victim of `slots` slots among `zones` known zones, evicted by one admission.
std::uint64_t operations_of_one_eviction(std::size_t zones, std::uint32_t slots) {
  Residency memory(zones, {ByteCount{slots} * kSlotSize, 0, kSlotSize, 0, {}, 0});
  const auto ignore = [](const Eviction&) {};
  const ZoneId victim = static_cast<ZoneId>(zones - 1);
  EXPECT_TRUE(memory.admit(victim, {slots, slots}, Purpose::kApproach, ignore).ok());
  memory.complete(victim, 1, {0, slots - 1, slots});
  const std::uint64_t before = memory.operations();
  EXPECT_EQ(*memory.admit(0, {slots, slots}, Purpose::kApproach, ignore), 1u);
  return memory.operations() - before;
}

TEST(ResidencyCost, OfAnEvictionIsTheSameForAnyZoneSizeAndAnyNumberOfZones) {
  const std::uint64_t least = operations_of_one_eviction(10, 1);
  EXPECT_EQ(least, 1u);  // taken off one list
  EXPECT_EQ(operations_of_one_eviction(10, 10'000), least);
  EXPECT_EQ(operations_of_one_eviction(100'000, 1), least);
  EXPECT_EQ(operations_of_one_eviction(100'000, 10'000), least);
}

}  // namespace
}  // namespace zonepack
