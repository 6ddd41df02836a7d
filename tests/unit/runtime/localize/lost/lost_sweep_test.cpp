// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/lost_sweep.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/runtime/localize/lost/made_places.hpp"

namespace zonepack::localize {
namespace {

constexpr std::int64_t kSweepSecond_ns = 1'000'000'000;

// Zones 0, 1, 2 in a row with doors between them, and 3 apart.
std::vector<SearchZone> row_of_zones() {
  return {{10, {0, 0}, {1}}, {30, {10, 0}, {0, 2}}, {20, {20, 0}, {1}}, {5, {11, 1}, {}}};
}

class LostSweepTest : public testing::Test {
 protected:
  ZoneId next(std::int64_t now_ns = 0) {
    return sweep.next(now_ns, [&](ZoneId zone) { return resident.contains(zone); });
  }
  // Loads the next zone and looks at it.
  ZoneId look(std::int64_t now_ns = 0) {
    const ZoneId zone = next(now_ns);
    if (zone == kNoZone) return zone;
    resident.insert(zone);
    EXPECT_EQ(next(now_ns), zone);
    sweep.look(zone, {});
    resident.clear();
    return zone;
  }
  std::set<ZoneId> resident;
  MadePlaces places;
  LostSweep sweep{row_of_zones(), places};
};

TEST_F(LostSweepTest, GoesFromTheLastZoneDoorByDoor) {
  sweep.begin(0, 2);
  EXPECT_EQ(next(), kNoZone);  // nothing to compare yet
  sweep.see(made_view(1, 0));
  for (const ZoneId zone : {2u, 1u, 0u, 3u}) EXPECT_EQ(look(), zone);
  EXPECT_EQ(next(), kNoZone);
  EXPECT_EQ(sweep.looked_at(), 4u);
}

// Without a last zone: zone 1, which has most signatures; then 0 and 2, both 10 m away.
TEST_F(LostSweepTest, BeginsWhereMostWasSeenWithoutALastZone) {
  sweep.begin(0, kNoZone);
  sweep.see(made_view(1, 0));
  for (const ZoneId zone : {1u, 0u, 2u, 3u}) EXPECT_EQ(look(), zone);
}

TEST_F(LostSweepTest, LooksFirstAtWhatIsInMemory) {
  sweep.begin(0, 2);
  sweep.see(made_view(1, 0));
  resident = {3};
  EXPECT_EQ(next(), 3u);
}

// A view that comes half-way is due in every zone; those not seen at all come first.
TEST_F(LostSweepTest, FinishesARoundBeforeItBeginsTheNext) {
  sweep.begin(0, 2);
  sweep.see(made_view(1, 0));
  EXPECT_EQ(look(), 2u);
  EXPECT_EQ(look(), 1u);
  sweep.see(made_view(2, 1));
  EXPECT_EQ(look(), 0u);
  EXPECT_EQ(look(), 3u);
  EXPECT_EQ(look(), 2u);
  EXPECT_EQ(look(), 1u);
  EXPECT_EQ(look(), kNoZone);
}

TEST_F(LostSweepTest, PassesOverAZoneThatDoesNotComeAndTriesItAgainWithAnotherView) {
  sweep.begin(0, 2);
  sweep.see(made_view(1, 0));
  EXPECT_EQ(next(0), 2u);
  EXPECT_EQ(next(7 * kSweepSecond_ns), 2u);
  EXPECT_EQ(next(8 * kSweepSecond_ns), 1u);
  ASSERT_EQ(sweep.passed_over().size(), 1u);
  EXPECT_EQ(sweep.passed_over()[0], 2u);
  for (const ZoneId zone : {1u, 0u, 3u}) EXPECT_EQ(look(8 * kSweepSecond_ns), zone);
  EXPECT_EQ(next(9 * kSweepSecond_ns), kNoZone);
  sweep.see(made_view(2, 1));
  EXPECT_EQ(next(9 * kSweepSecond_ns), 2u);
}

TEST_F(LostSweepTest, AsksForATurnOnceTheWholeMapWasSeen) {
  sweep.begin(0, 2);
  sweep.see(made_view(1, 0));
  for (int i = 0; i < 3; ++i) look();
  EXPECT_FALSE(sweep.asks_for_turn(0));
  look();
  EXPECT_TRUE(sweep.asks_for_turn(0));
  EXPECT_FALSE(sweep.asks_for_turn(14 * kSweepSecond_ns));
  EXPECT_TRUE(sweep.asks_for_turn(15 * kSweepSecond_ns));
}

// The wheels' frame is at (10, 5). The third image, 1 m on, was no view of the place: carried from
// the first of the best, at (10.4, 5), it is at (11, 5), and 2 cm + 3 % of 0.6 m wider than 2 cm.
TEST_F(LostSweepTest, GivesFixesForTheNewestImagesOnceThePlaceIsFound) {
  sweep.begin(0, 0);
  const int distinct[] = {40, 40, 60};
  for (std::uint64_t i = 1; i <= 3; ++i) {
    const double x_m = 0.2 * static_cast<double>(i - 1);
    sweep.see(made_view(i, x_m));
    places.guesses[{i, 0}] = {made_sight({10 + x_m, 5, 0}, distinct[i - 1], 100)};
  }
  sweep.see(made_view(4, 1));
  EXPECT_TRUE(sweep.found(2 * kSweepSecond_ns).empty());
  look();
  const auto fixes = sweep.found(2 * kSweepSecond_ns);
  ASSERT_EQ(fixes.size(), 3u);
  EXPECT_EQ(fixes[0].stamp_ns, kSweepSecond_ns);
  EXPECT_NEAR(fixes[0].pose.x_m, 10.2, 1e-9);
  EXPECT_TRUE(fixes[0].seen);
  EXPECT_EQ(fixes[2].stamp_ns, 2 * kSweepSecond_ns);
  EXPECT_FALSE(fixes[2].seen);
  EXPECT_NEAR(fixes[2].pose.x_m, 11, 1e-9);
  EXPECT_NEAR(fixes[2].sigma_m - fixes[1].sigma_m, 0.02 + 0.03 * 0.6, 1e-9);
  // Too old for the pose's history, some seconds later.
  EXPECT_TRUE(sweep.found(10 * kSweepSecond_ns).empty());
}

}  // namespace
}  // namespace zonepack::localize
