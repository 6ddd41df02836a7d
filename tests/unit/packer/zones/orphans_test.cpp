// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/orphans.hpp"

#include <gtest/gtest.h>

namespace zonepack::packer {
namespace {

// "Hall" x 0 to 20, y 0 to 4; "Lobby" x 20 to 30, y 0 to 8.
std::vector<PlannedZone> hall_and_lobby() {
  std::vector<PlannedZone> zones(2);
  zones[0].name = "Hall";
  zones[0].polygon.outer = {{0, 0}, {20, 0}, {20, 4}, {0, 4}};
  zones[1].name = "Lobby";
  zones[1].polygon.outer = {{20, 0}, {30, 0}, {30, 8}, {20, 8}};
  return zones;
}

std::vector<SignaturePlace> at(const std::vector<Point2>& points) {
  std::vector<SignaturePlace> places;
  for (const Point2 p : points) {
    places.push_back({static_cast<SignatureId>(places.size() + 1), p, 0});
  }
  return places;
}

std::vector<OrphanGroup> groups_of(const std::vector<Point2>& points) {
  return group_orphans(partition(hall_and_lobby(), at(points), OrphanPolicy::kDrop).orphans);
}

TEST(Orphans, AreSummedUpByTheirNearestZone) {
  // 0.3 and 0.52 m right of the lobby, 0.4 m below the hall; the last is in the hall.
  const auto groups = groups_of({{30.3, 1}, {30.52, 2}, {5, -0.4}, {5, 1}});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].count, 2u);
  EXPECT_EQ(groups[0].example, 1u);
  EXPECT_EQ(orphans_text(groups, hall_and_lobby()), "3 in none, 2 of them within 0.6 m of Lobby");
  EXPECT_EQ(near_text(groups[1], hall_and_lobby()), "within 0.4 m of Hall");
}

TEST(Orphans, FarOffAreCountedApart) {
  // 12.2 m right of the lobby, rounded up to whole metres.
  const auto groups = groups_of({{30.3, 1}, {42.2, 2}});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(near_text(groups[0], hall_and_lobby()), "within 0.3 m of Lobby");
  EXPECT_EQ(near_text(groups[1], hall_and_lobby()), "1 to 13 m from Lobby");
}

TEST(Orphans, ReadWellInSmallNumbers) {
  EXPECT_EQ(orphans_text(groups_of({{1, 1}}), hall_and_lobby()), "0 in none");
  EXPECT_EQ(orphans_text(groups_of({{30.3, 1}}), hall_and_lobby()),
            "1 in none, within 0.3 m of Lobby");
  EXPECT_EQ(orphans_text(groups_of({{30.3, 1}, {30.1, 1}}), hall_and_lobby()),
            "2 in none, both within 0.3 m of Lobby");
}

std::optional<Misdrawn> misdrawn(const std::vector<Point2>& points) {
  const auto places = at(points);
  return find_misdrawn(hall_and_lobby(), places, count_outside(hall_and_lobby(), places));
}

TEST(Misdrawn, RecognisesSwappedAxes) {
  // The robot drove along y, at x = 1 to 3; only (1, 2) and (3, 1) are in the hall as drawn.
  const std::vector<Point2> drive{{1, 2}, {1, 6}, {2, 10}, {2, 15}, {3, 19}, {3, 25}, {3, 1}};
  const auto found = misdrawn(drive);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->how, "x and y swapped");
  EXPECT_EQ(found->orphans, 0u);
  EXPECT_EQ(misdrawn_text(*found, 5, 7).substr(0, 47),
            "5 of 7 in no zone; with x and y swapped 0: the ");
}

TEST(Misdrawn, RecognisesMirrorsTurnsAndUnits) {
  EXPECT_EQ(misdrawn({{1, -2}, {9, -3}, {25, -7}}).value().how, "y mirrored");
  EXPECT_EQ(misdrawn({{-1, 2}, {-9, 3}, {-25, 7}}).value().how, "x mirrored");
  EXPECT_EQ(misdrawn({{-1, -2}, {-9, -3}, {-25, -7}}).value().how, "a half turn");
}

TEST(Misdrawn, RecognisesCentimetres) {
  std::vector<PlannedZone> zones = hall_and_lobby();
  for (PlannedZone& zone : zones) {
    for (Point2& p : zone.polygon.outer) p = {p.x_m * 100 + 500, p.y_m * 100 + 500};
  }
  // The hall is x 500 to 2500 cm: 5 to 25 m; the lobby 25 to 35 m; y from 5 m.
  const auto places = at({{6, 6}, {20, 7}, {30, 12}});
  EXPECT_EQ(count_outside(zones, places), 3u);
  EXPECT_EQ(find_misdrawn(zones, places, 3).value().how, "coordinates read as centimetres");
}

TEST(Misdrawn, SaysNothingUnlessItIsMuchBetter) {
  EXPECT_FALSE(misdrawn({{1, 2}, {9, 3}, {25, 7}}));                   // all inside
  EXPECT_FALSE(misdrawn({{1, 2}, {9, 3}, {25, 7}, {8, 3}, {2, 25}}));  // 1 of 5: below a quarter
  EXPECT_FALSE(misdrawn({{40, 40}, {50, 50}, {60, 60}}));              // outside either way
}

}  // namespace
}  // namespace zonepack::packer
