// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/layout.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/tune/ground_plan.hpp"

namespace zonepack::packer::tune {
namespace {

TEST(Layout, SmallestBudgetIsThatOfTheLargestPairOfNeighbours) {
  GroundPlan plan = three_rooms();
  const Smallest smallest = smallest_of(plan.layout);
  EXPECT_EQ(smallest.pair_slots, 50u);  // A and C
  EXPECT_EQ(smallest.pairs, 1u);
  EXPECT_EQ(smallest.text, "A with C");
  EXPECT_EQ(smallest.bytes, charged_with(plan.layout.fixed_bytes(), 50));
  plan.layout.zones[1].pinned = true;  // A is held besides the pair of B, 10, and of C, 40
  EXPECT_EQ(smallest_of(plan.layout).pair_slots, 40u);
  EXPECT_EQ(smallest_of(plan.layout).bytes, charged_with(plan.layout.fixed_bytes(), 50));
}

TEST(Layout, GivesUpTheZoneUsedLeastRecently) {
  const GroundPlan plan = three_rooms();
  // B A C A B A C: with 50 slots C pushes out B, and B, at the end of A's visit, C.
  const Track track = plan.drive("d", {-15, 5, -15, 5});
  ASSERT_EQ(track.visits.size(), 7u);
  const DriveCost cost = cost_of(track.visits, plan.layout, 50);
  EXPECT_EQ(cost.loads, 5u);  // B, A, C, B, C
  EXPECT_EQ(cost.signatures, 10u + 10 + 40 + 10 + 40);
  EXPECT_EQ(cost.stored, 110'000u);
  EXPECT_EQ(cost_of(track.visits, plan.layout, 60).loads, 3u);  // all fit
}

TEST(Layout, PinnedZonesAreNeverLoaded) {
  GroundPlan plan = three_rooms();
  plan.layout.zones[2].pinned = true;
  const Track track = plan.drive("d", {-15, 5, -15, 5});
  EXPECT_EQ(cost_of(track.visits, plan.layout, 20).loads, 2u);  // B and A
}

TEST(Layout, FixedBytesGrowWithNamesVerticesAndPortals) {
  GroundPlan plan = three_rooms();
  const ByteCount before = plan.layout.fixed_bytes();
  plan.add("D", 40, 50);
  plan.join(2, 3, 40);
  // 640 and 4 a letter of "D" and "room", a ring of 96 with 4 vertices of 32, and "C-D".
  EXPECT_EQ(plan.layout.fixed_bytes() - before, 640u + 5 * 4 + 96 + 4 * 32 + 192 + 3);
}

}  // namespace
}  // namespace zonepack::packer::tune
