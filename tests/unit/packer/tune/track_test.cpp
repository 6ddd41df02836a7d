// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/track.hpp"

#include <gtest/gtest.h>

#include "tests/unit/packer/tune/ground_plan.hpp"

namespace zonepack::packer::tune {
namespace {

DrivenPath drive_of(const std::vector<DrivePose>& poses) { return {"d", false, poses, 0}; }

TEST(Track, HasAPlaceEveryFiveCentimetres) {
  const Track track = track_of(drive_of({{0, {0, 0}, 0}, {10, {1, 0}, 1}}), "d");
  ASSERT_EQ(track.places.size(), 21u);
  EXPECT_NEAR(track.places[1].p_map.x_m, 0.05, 1e-12);
  EXPECT_NEAR(track.places[10].z_map_m, 0.5, 1e-12);
  EXPECT_NEAR(track.metres, 1, 1e-12);
  EXPECT_EQ(track.seconds, 10);
}

TEST(Track, AddsNothingWhileTheRobotStandsAndJoinsNoPosesFarApart) {
  EXPECT_EQ(
      track_of(drive_of({{0, {0, 0}, 0}, {1, {0.01, 0}, 0}, {2, {0, 0.01}, 0}}), "d").places.size(),
      1u);
  const Track lost = track_of(drive_of({{0, {0, 0}, 0}, {1, {20, 0}, 0}}), "d");
  EXPECT_EQ(lost.places.size(), 2u);
  EXPECT_EQ(lost.metres, 0);
}

TEST(Track, EntersAZoneOnceItIsDeepEnoughInIt) {
  GroundPlan plan;
  plan.add("A", 0, 10);
  plan.add("B", 10, 20);
  // 5 cm into B and back is no visit, 20 cm is.
  EXPECT_EQ(plan.drive("d", {5, 10.05, 5}).visits.size(), 1u);
  const Track track = plan.drive("d", {5, 10.2, 5});
  ASSERT_EQ(track.visits.size(), 3u);
  EXPECT_EQ(track.visits[1].zone, 1u);
  EXPECT_EQ(track.visits[0].last + 1, track.visits[1].first);
}

TEST(Track, StaysInItsZoneOutsideOfAll) {
  GroundPlan plan;
  plan.add("A", 0, 10);
  const Track track = plan.drive("d", {5, 15, 5});
  ASSERT_EQ(track.visits.size(), 1u);
  EXPECT_EQ(track.visits[0].last, track.places.size() - 1);
}

TEST(Track, IsHalvedAtTheMiddleOfItsTime) {
  const auto halves =
      halves_of(drive_of({{0, {0, 0}, 0}, {4, {1, 0}, 0}, {5, {2, 0}, 0}, {10, {3, 0}, 0}}));
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_EQ(halves[0].poses.size(), 2u);  // 0 s and 4 s
  EXPECT_EQ(halves[1].poses.size(), 2u);  // 5 s and 10 s
}

}  // namespace
}  // namespace zonepack::packer::tune
