// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "packer/zones/plane.hpp"
#include "tests/unit/packer/tune/ground_plan.hpp"

namespace zonepack::packer::tune {
namespace {

GroundPlan hall() {
  GroundPlan plan;
  plan.add("A", -10, 0);
  plan.add("C", 0, 20);
  plan.join(0, 1, 0);
  return plan;
}

Change cut_at(std::uint32_t zone, double x_m) {
  return {Change::Kind::kSplit, zone, zone, Axis{1, 0}, x_m};
}

TEST(Split, GivesEachPartItsSignaturesAndAPortalOfTheWholeWidth) {
  const GroundPlan plan = hall();
  const auto after = changed(plan.layout, plan.signatures, cut_at(1, 8));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->names.into, (std::vector<std::string>{"C_1", "C_2"}));
  ASSERT_EQ(after->fresh, (std::vector<std::uint32_t>{2, 3}));
  const Layout& layout = after->layout;
  EXPECT_FALSE(layout.zones[1].alive);
  EXPECT_EQ(layout.living(), 3u);
  EXPECT_EQ(layout.zones[2].members.size(), 8u);
  EXPECT_EQ(layout.zones[3].members.size(), 12u);
  EXPECT_EQ(layout.zones[2].cost.stored, 8000u);
  EXPECT_EQ(layout.zones[2].cost.slots, 8u);  // 8 of 20 signatures, 7.8 of 19.5 slots
  ASSERT_EQ(layout.portals.size(), 2u);
  EXPECT_EQ(layout.portals[0].name, "A-C");
  EXPECT_EQ(layout.portals[0].zone_b, 2u);  // the door at x = 0 leads to the part below the cut
  EXPECT_EQ(layout.portals[1].name, "C_1-C_2");
  EXPECT_NEAR(distance_m(layout.portals[1].segment.p, layout.portals[1].segment.q), 2, 1e-9);
}

TEST(Split, TakesNamesThatNoZoneHas) {
  GroundPlan plan = hall();
  plan.add("C_1", 20, 30);
  const auto after = changed(plan.layout, plan.signatures, cut_at(1, 8));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->names.into, (std::vector<std::string>{"C_2", "C_3"}));
}

TEST(Split, IsNotProposedThroughADoorButThroughOpenGround) {
  GroundPlan plan = hall();
  // A door of 2 m in the wall above, and none of the cuts within 0.3 m of it.
  plan.layout.portals.push_back({"door", 1, 0, {{9, 2}, {11, 2}}});
  const auto along = [](const Change& change) { return change.axis.ux > 0.5; };
  auto cuts = splits_of(plan.layout, plan.signatures, 1, 24);
  ASSERT_GT(std::ranges::count_if(cuts, along), 3);
  for (const Change& cut : cuts) {
    EXPECT_GE(cut.place_m, kLeastPart_m);
    EXPECT_TRUE(cut.place_m < 8.7 || cut.place_m > 11.3) << cut.place_m;
  }
  // 6 m of open ground may be parted, but a rest under 0.8 m may not stay.
  plan.layout.portals.back().segment = {{7, 2}, {13, 2}};
  cuts = splits_of(plan.layout, plan.signatures, 1, 24);
  EXPECT_TRUE(std::ranges::any_of(
      cuts, [](const Change& cut) { return cut.place_m > 8 && cut.place_m < 12; }));
  EXPECT_TRUE(std::ranges::none_of(
      cuts, [](const Change& cut) { return cut.place_m > 6.7 && cut.place_m < 7.8; }));
  const auto after = changed(plan.layout, plan.signatures, cut_at(1, 9));
  ASSERT_TRUE(after);
  const auto piece = std::ranges::find(after->layout.portals, "door.1", &PlannedPortal::name);
  ASSERT_NE(piece, after->layout.portals.end());
  EXPECT_EQ(piece->zone_a, after->fresh[0]);
  EXPECT_NEAR(piece->segment.q.x_m, 9, 1e-9);
}

TEST(Split, LeavesPinnedZonesAlone) {
  GroundPlan plan = hall();
  plan.layout.zones[1].pinned = true;
  EXPECT_TRUE(splits_of(plan.layout, plan.signatures, 1, 24).empty());
  EXPECT_TRUE(merges_of(plan.layout).empty());
}

TEST(Split, OfAZoneIsFollowedByTheVisits) {
  const GroundPlan plan = hall();
  const Change change = cut_at(1, 8);
  const auto after = changed(plan.layout, plan.signatures, change);
  Track track = plan.drive("d", {-5, 5, -5, 15});
  ASSERT_EQ(track.visits.size(), 4u);  // A C A C
  follow(track, change, *after);
  std::vector<std::uint32_t> zones;
  for (const Visit& visit : track.visits) zones.push_back(visit.zone);
  EXPECT_EQ(zones, (std::vector<std::uint32_t>{0, 2, 0, 2, 3}));
  // The same as if the drive were looked up in the new zones.
  EXPECT_EQ(visits_of(track.places).size(), track.visits.size());
}

TEST(Merge, JoinsOutlinesSignaturesAndPortals) {
  GroundPlan plan = hall();
  plan.add("B", 20, 25);
  plan.join(1, 2, 20);
  const Change change{Change::Kind::kMerge, 1, 0, {}, 0};
  const auto after = changed(plan.layout, plan.signatures, change);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->names.into, (std::vector<std::string>{"A+C"}));
  const TunedZone& zone = after->layout.zones[after->fresh[0]];
  EXPECT_NEAR(area_m2(zone.zone.polygon), 60, 1e-6);
  EXPECT_EQ(zone.members.size(), 30u);
  EXPECT_TRUE(std::ranges::is_sorted(zone.members));
  ASSERT_EQ(after->layout.portals.size(), 1u);  // the one between them is gone
  EXPECT_EQ(after->layout.portals[0].zone_a, after->fresh[0]);
  Track track = plan.drive("d", {-5, 22, -5});
  follow(track, change, *after);
  EXPECT_EQ(track.visits.size(), 3u);  // A+C, B, A+C
}

TEST(Merge, NeedsOneLayerFloorAndHeight) {
  GroundPlan plan = hall();
  EXPECT_EQ(merges_of(plan.layout).size(), 1u);
  plan.layout.zones[0].zone.layer = "skeleton";
  EXPECT_TRUE(merges_of(plan.layout).empty());
  plan.layout.zones[1].zone.layer = "skeleton";
  plan.layout.zones[1].zone.z_max_m = 3;
  EXPECT_TRUE(merges_of(plan.layout).empty());
}

TEST(Joined, FillsTheWallBetweenTwoRooms) {
  const Polygon left{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
  const Polygon right{{{4.1, 1}, {8, 1}, {8, 5}, {4.1, 5}}, {}};
  const auto both = joined(left, right);
  ASSERT_TRUE(both);
  // 12 and 15.6, and 0.1 of the wall for the 2 m along which they are side by side.
  EXPECT_NEAR(area_m2(*both), 12 + 15.6 + 0.2, 0.02);
  EXPECT_EQ(side_of(*both, {4.05, 2}), Side::kInside);
  EXPECT_EQ(side_of(*both, {4.05, 0.5}), Side::kOutside);
  EXPECT_TRUE(self_crossings(both->outer).empty());
}

TEST(Joined, KeepsAYardBetweenTwoHalvesAsAHole) {
  // Two Cs that make a ring of 6 x 6 around a yard of 2 x 2.
  const Polygon left{{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 4}, {3, 4}, {3, 6}, {0, 6}}, {}};
  const Polygon right{{{3, 0}, {6, 0}, {6, 6}, {3, 6}, {3, 4}, {4, 4}, {4, 2}, {3, 2}}, {}};
  const auto both = joined(left, right);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->holes.size(), 1u);
  EXPECT_NEAR(area_m2(*both), 32, 1e-6);
}

TEST(Joined, IsNothingForRoomsThatAreApart) {
  const Polygon left{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
  const Polygon right{{{4.5, 0}, {8, 0}, {8, 3}, {4.5, 3}}, {}};
  EXPECT_FALSE(joined(left, right));
}

}  // namespace
}  // namespace zonepack::packer::tune
