// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/policies/orders.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "runtime/evaluate/policies/eviction_names.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/zones/transitions.hpp"
#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

// Six slots of 100 bytes; zones A to H of one slot each, but G takes two and H three.
class Orders : public testing::Test {
 protected:
  static constexpr std::uint32_t kSlots = 6;
  const ResidencyLimits limits{
      .budget = kSlots * 100, .slot_bytes = 100, .largest_pair = {.slots = 5, .signatures = 5}};
  const std::vector<ZoneNeed> needs{{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {2, 2}, {3, 3}};
  // Eight rooms that no door joins: no forecast.
  const ZoneGraph graph{std::vector<GraphZone>(8, {"", testing_support::box(0, 0, 1, 1)}), {}};
  const Transitions transitions{graph};
  std::unique_ptr<EvictionOrder> order;
  std::unique_ptr<Residency> memory;

  void hold(EvictionOrderMaker make) {
    order = make({needs, kSlots, &transitions});
    memory = std::make_unique<Residency>(needs.size(), limits, order.get());
  }

  // Needs each zone for a moment, one after the other, or loads it ahead of that; returns those
  // evicted meanwhile.
  std::string drive(const std::string& zones, bool needed = true) {
    std::string evicted;
    for (const char name : zones) {
      const auto zone = static_cast<ZoneId>(name - 'A');
      if (needed) memory->request(zone);
      memory->protect(zone);
      if (!memory->resident(zone)) {
        const auto admitted = memory->admit(
            zone, needs[zone], Purpose::kOwnZone,
            [&](const Eviction& eviction) { evicted += static_cast<char>('A' + eviction.zone); });
        EXPECT_TRUE(admitted.ok());
        memory->complete(zone, memory->generation(zone), {0, 0, needs[zone].slots});
      }
      memory->unprotect(zone);
    }
    return evicted;
  }
};

TEST_F(Orders, LruEvictsTheZoneUsedLeastRecently) {
  hold(make_lru_order);
  EXPECT_EQ(drive("ABCDEFA"), "");
  // A was used last; H needs three slots.
  EXPECT_EQ(drive("H"), "BCD");
}

TEST_F(Orders, FifoEvictsTheZoneLoadedFirstHoweverOftenItIsUsed) {
  hold(make_fifo_order);
  EXPECT_EQ(drive("ABCDEFAAA"), "");
  EXPECT_EQ(drive("H"), "ABC");
}

TEST_F(Orders, LfuEvictsTheZoneUsedLeastAndOfSeveralTheOneUsedLeastRecently) {
  hold(make_lfu_order);
  // Uses: A 3, B 2, C 1, D 1, E 1, F 2; of C, D and E, C was used least recently.
  EXPECT_EQ(drive("ABCDEFAABF"), "");
  EXPECT_EQ(drive("G"), "CD");
  // Loaded again, C begins with one use, as E and G have: E was used least recently.
  EXPECT_EQ(drive("C"), "E");
}

TEST_F(Orders, GdsfEvictsLargeZonesUsedSeldomAndAges) {
  hold(make_gdsf_order);
  // Priorities: H 1/3, A 2, B 1, C 1.
  EXPECT_EQ(drive("HABCA"), "");
  // H goes, and L is 1/3: D is at 1 1/3 and fits; E and F too, at 1 1/3.
  EXPECT_EQ(drive("DEF"), "H");
  // G needs two: B and C, at 1, go before D at 1 1/3. L is 1, G at 1 + 1/2.
  EXPECT_EQ(drive("G"), "BC");
  // D, E at 1 1/3 go before G at 1 1/2; H at 1 1/3 + 1/3.
  EXPECT_EQ(drive("H"), "DEF");
}

TEST_F(Orders, S3FifoKeepsWhatCameBackAndForgetsWhatWasUsedOnce) {
  hold(make_s3_fifo_order);
  // A and B are used twice more, so they move to the main queue; C was not and goes, then D.
  EXPECT_EQ(drive("ABCDEFAABB"), "");
  EXPECT_EQ(drive("G"), "CD");
  // C and D are remembered. C enters the main queue; E goes and is remembered.
  EXPECT_EQ(drive("C"), "E");
  // The same with D and F. The main queue is A, B, C, D, of which A and B were used; the small one
  // G.
  EXPECT_EQ(drive("D"), "F");
  // G goes for F; E fits besides. H is three: A and B get another round, C, D and F do not.
  EXPECT_EQ(drive("FEH"), "GCDF");
}

TEST_F(Orders, S3FifoLetsWhatCameBackOutliveAScan) {
  hold(make_s3_fifo_order);
  // B is the one that the ghost queue remembers, and comes back to the main queue.
  EXPECT_EQ(drive("ABCDEF"), "");
  EXPECT_EQ(drive("G"), "AB");
  EXPECT_EQ(drive("B"), "C");
  // The scan goes through the small queue; B is older than what it brought, and stays.
  EXPECT_EQ(drive("ACDE"), "DEFG");
  EXPECT_EQ(drive("F"), "");
  EXPECT_EQ(drive("H"), "ACD");
}

TEST_F(Orders, S3FifoGivesAnotherRoundInTheMainQueueForEachUse) {
  hold(make_s3_fifo_order);
  // All six used twice more: all move to main on the first eviction, uses 2 each, but F is used
  // once more. From there: A to F lose a use, then another; A is the first without.
  EXPECT_EQ(drive("ABCDEFABCDEFABCDEFF"), "");
  EXPECT_EQ(drive("G"), "AB");
}

TEST_F(Orders, SieveEvictsTheFirstUnmarkedFromItsHandOn) {
  hold(make_sieve_order);
  EXPECT_EQ(drive("ABCDEFAC"), "");
  // Marks: A, C. The hand clears A, evicts B, clears C, evicts D; G is the newest.
  EXPECT_EQ(drive("G"), "BD");
  // From E on: E, then F; A and C are older than the hand and stay.
  EXPECT_EQ(drive("BD"), "EF");
  // G, B and D are without a mark: the hand goes on to G, which makes room for two.
  EXPECT_EQ(drive("E"), "G");
  EXPECT_EQ(drive("F"), "");
}

TEST_F(Orders, SieveNeverEvictsAProtectedZoneAndKeepsItsMark) {
  hold(make_sieve_order);
  EXPECT_EQ(drive("ABCHA"), "");
  memory->protect(0);
  // The hand passes A over, with its mark.
  EXPECT_EQ(drive("DEF"), "BCH");
  EXPECT_EQ(drive("G"), "");
  memory->unprotect(0);
  EXPECT_EQ(drive("BCDEF"), "DEFG");
  // All others are marked: the hand clears B to F and then A, before it evicts B and C.
  EXPECT_EQ(drive("BCDEF"), "");
  EXPECT_EQ(drive("G"), "BC");
}

TEST_F(Orders, EveryOrderEvictsOnlyCandidatesWhateverIsProtected) {
  for (const NamedEviction& policy : eviction_policies()) {
    SCOPED_TRACE(policy.name);
    hold(policy.make);
    drive("ABCDEF");
    // All but D: Residency requires that the choice is a candidate, D.
    for (const ZoneId zone : {0u, 1u, 2u, 4u, 5u}) {
      memory->request(zone);
      memory->request(zone);
      memory->protect(zone);
    }
    memory->request(3);
    memory->request(3);
    memory->request(3);
    std::string evicted;
    const auto admitted = memory->admit(6, {1, 1}, Purpose::kOwnZone, [&](const Eviction& gone) {
      evicted += static_cast<char>('A' + gone.zone);
    });
    EXPECT_TRUE(admitted.ok());
    EXPECT_EQ(evicted, "D");
  }
}

TEST_F(Orders, LruAsAnOrderChoosesWhatResidencyChoosesWithoutOne) {
  std::uint32_t random = 7;
  std::string zones;
  for (int i = 0; i < 2000; ++i) {
    random = random * 1664525 + 1013904223;
    zones += static_cast<char>('A' + (random >> 16) % 8);
  }
  hold(make_lru_order);
  const std::string with = drive(zones);
  order.reset();
  memory = std::make_unique<Residency>(needs.size(), limits, nullptr);
  EXPECT_EQ(drive(zones), with);
  EXPECT_GT(with.size(), 100u);
}

// Whatever is loaded ahead of any request, or comes back before it is needed: each choice is a
// candidate, which Residency requires, and nothing is kept twice.
TEST_F(Orders, HoldForZonesThatAreLoadedAhead) {
  for (const NamedEviction& policy : eviction_policies()) {
    SCOPED_TRACE(policy.name);
    hold(policy.make);
    std::minstd_rand random(7);
    std::size_t evicted = 0;
    for (int i = 0; i < 5000; ++i) {
      const bool needed = random() % 2 == 0;
      evicted += drive(std::string(1, static_cast<char>('A' + random() % 8)), needed).size();
    }
    EXPECT_GT(evicted, 1000u);
    EXPECT_LE(memory->charged(), limits.budget);
  }
}

}  // namespace
}  // namespace zonepack
