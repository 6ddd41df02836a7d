// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/tracker.hpp"

#include <gtest/gtest.h>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::pose_at;
using testing_support::three_rooms;

class Tracker : public testing::Test {
 protected:
  const ZoneGraph graph = three_rooms();
  ZoneTracker tracker{graph};
};

TEST_F(Tracker, IsNowhereBeforeTheFirstValidPose) {
  PoseEstimate pose = pose_at(2, 2);
  pose.valid = false;
  EXPECT_FALSE(tracker.update(pose));
  EXPECT_EQ(tracker.zone(), kNoZone);
}

TEST_F(Tracker, StartsInTheZoneOfThePoseOrTheNearest) {
  EXPECT_TRUE(tracker.update(pose_at(2, 2)));
  EXPECT_EQ(tracker.zone(), 0u);
  ZoneTracker other(graph);
  EXPECT_FALSE(other.update(pose_at(14, 2)));  // 2 m off c: more than 1 m + 3 * 0.03 m
  EXPECT_EQ(other.zone(), kNoZone);
  EXPECT_TRUE(other.update(pose_at(13, 2)));
  EXPECT_EQ(other.zone(), 2u);
}

TEST_F(Tracker, SwitchesBehindADoorOnlyOnceThePoseIsDeepEnough) {
  tracker.update(pose_at(3, 2));
  EXPECT_FALSE(tracker.update(pose_at(4.04, 2)));  // 4 cm, needed: 5 cm
  EXPECT_EQ(tracker.zone(), 0u);
  EXPECT_EQ(tracker.pose_zone(), 1u);
  EXPECT_TRUE(tracker.update(pose_at(4.06, 2)));
  EXPECT_EQ(tracker.zone(), 1u);
}

TEST_F(Tracker, DoesNotSwitchToAndFroOnABorder) {
  tracker.update(pose_at(3, 2));
  int switches = 0;
  for (int i = 0; i < 100; ++i) switches += tracker.update(pose_at(i % 2 ? 4.04 : 3.96, 2));
  EXPECT_EQ(switches, 0);
}

TEST_F(Tracker, AsksForMoreDepthOfAnUncertainPoseButNeverMoreThanItsLimit) {
  tracker.update(pose_at(3, 2, 0, 0.1));
  EXPECT_FALSE(tracker.update(pose_at(4.09, 2, 0, 0.1)));
  EXPECT_TRUE(tracker.update(pose_at(4.11, 2, 0, 0.1)));
  EXPECT_FALSE(tracker.update(pose_at(3.86, 2, 0, 0.5)));
  EXPECT_TRUE(tracker.update(pose_at(3.84, 2, 0, 0.5)));  // 16 cm > 15 cm
}

TEST_F(Tracker, DoesNotGoThroughAWallOnWeakEvidence) {
  tracker.update(pose_at(3.5, 0.4));
  // The door's end (4, 1.5) is 1.1 m away; through the wall it takes 0.3 + 3 * 0.03 = 0.39 m.
  EXPECT_FALSE(tracker.update(pose_at(4.38, 0.4)));
  EXPECT_EQ(tracker.zone(), 0u);
  EXPECT_TRUE(tracker.update(pose_at(4.40, 0.4)));
}

TEST_F(Tracker, StaysWhereItWasWhileThePoseIsOutsideOfAllZones) {
  tracker.update(pose_at(3, 2));
  EXPECT_FALSE(tracker.update(pose_at(3, -3)));
  EXPECT_EQ(tracker.zone(), 0u);
  EXPECT_EQ(tracker.pose_zone(), 0u);
}

TEST_F(Tracker, BelievesThePoseAloneAfterARestart) {
  tracker.update(pose_at(2, 2));
  tracker.restart();
  EXPECT_TRUE(tracker.update(pose_at(8.1, 0.5)));
  EXPECT_EQ(tracker.zone(), 2u);
}

TEST_F(Tracker, ConfirmedBehindADoorIsBelievedAgainstAPoseThatLags) {
  tracker.update(pose_at(3, 2));
  tracker.confirm(1, 1.0);
  EXPECT_EQ(tracker.zone(), 1u);
  EXPECT_FALSE(tracker.update(pose_at(3.5, 2)));  // half a metre behind: without it, back in a
  EXPECT_EQ(tracker.zone(), 1u);
  EXPECT_EQ(tracker.pose_zone(), 0u);
  EXPECT_FALSE(tracker.update(pose_at(4.3, 2)));  // arrived: from here on the pose alone decides
  EXPECT_TRUE(tracker.update(pose_at(3.5, 2)));
  EXPECT_EQ(tracker.zone(), 0u);
}

TEST_F(Tracker, ConfirmedIsGivenUpWhenThePoseGoesAwayFromTheDoor) {
  tracker.update(pose_at(3, 2));
  tracker.confirm(1, 1.0);
  EXPECT_FALSE(tracker.update(pose_at(2.95, 2)));  // 1.05 m; 1 m and three times 3 cm
  EXPECT_TRUE(tracker.update(pose_at(2.9, 2)));
  EXPECT_EQ(tracker.zone(), 0u);
}

TEST_F(Tracker, ConfirmingItsOwnZoneChangesNothing) {
  tracker.update(pose_at(3, 2));
  tracker.confirm(0, 1.0);
  EXPECT_TRUE(tracker.update(pose_at(4.06, 2)));
  EXPECT_EQ(tracker.zone(), 1u);
}

}  // namespace
}  // namespace zonepack
