// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/zone_markers.hpp"

#include <gtest/gtest.h>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::pose_at;

// Rooms a, b, c with doors at (4, 2) and (8, 2), rooms.hpp.
class Markers : public testing::Test {
 protected:
  static PoseEstimate moving(double x_m, double yaw_rad, double speed_m_s = 0.5) {
    PoseEstimate pose = pose_at(x_m, 2, yaw_rad);
    pose.speed_m_s = speed_m_s;
    return pose;
  }

  const ZoneGraph graph = testing_support::three_rooms();
  const std::vector<ZoneMarkerSettings> settings = {
      {.name = "door", .zone = "a", .other = "b", .reach_m = 0.5},
      {.name = "beacon", .zone = "c", .other = "", .reach_m = 0.5},
      {.name = "gone", .zone = "a", .other = "x", .reach_m = 0.5}};
  const ZoneMarkers markers{graph, settings};
};

TEST_F(Markers, ADoorLeadsToTheSideThatTheRobotMovesTo) {
  EXPECT_EQ(markers.pass(0, moving(3.8, 0), 0).zone, 1u);
  EXPECT_EQ(markers.pass(0, moving(3.8, 3.14), 0).zone, 0u);  // away from the door
  EXPECT_EQ(markers.pass(0, moving(4.3, 0), 1).zone, 1u);     // the pose was ahead already
  EXPECT_EQ(markers.pass(0, moving(4.3, 3.14), 1).zone, 0u);
  EXPECT_EQ(markers.pass(0, moving(3.8, 3.14, -0.5), 0).zone, 1u);  // backwards through it
}

TEST_F(Markers, ASidewaysRobotPassesADoorToo) {
  PoseEstimate pose = moving(3.8, 1.5707963, 0);
  pose.sideways_m_s = -0.5;  // to the right, which is towards b
  EXPECT_EQ(markers.pass(0, pose, 0).zone, 1u);
}

TEST_F(Markers, AreNotBelievedFarFromTheirDoorButForAnUncertainPose) {
  // 0.6 m off the door; it reaches 0.5 m and three times 3 cm.
  EXPECT_STREQ(markers.pass(0, moving(3.4, 0), 0).refused, "elsewhere");
  EXPECT_EQ(markers.pass(0, moving(3.42, 0), 0).zone, 1u);
  PoseEstimate unsure = moving(3.0, 0);
  unsure.covariance.xx = unsure.covariance.yy = 0.04;  // 0.2 m
  EXPECT_EQ(markers.pass(0, unsure, 0).zone, 1u);
  EXPECT_STREQ(markers.pass(0, moving(4, 0), 2).refused, "elsewhere");  // in neither of its zones
}

TEST_F(Markers, AStandingRobotDoesNotPassADoor) {
  EXPECT_STREQ(markers.pass(0, moving(3.9, 0, 0), 0).refused, "standing");
  EXPECT_STREQ(markers.pass(0, moving(3.9, 1.5707963), 0).refused, "standing");  // along the wall
}

TEST_F(Markers, ABeaconConfirmsItsZoneFromInsideOrThroughADoorNearby) {
  EXPECT_EQ(markers.pass(1, moving(10, 0, 0), 2).zone, 2u);
  EXPECT_EQ(markers.pass(1, moving(7.8, 0, 0), 1).zone, 2u);
  EXPECT_STREQ(markers.pass(1, moving(6, 0), 1).refused, "elsewhere");
  EXPECT_STREQ(markers.pass(1, moving(4, 0), 0).refused, "elsewhere");
}

TEST_F(Markers, WithoutAPoseOrAZoneOfTheMapNothingIsBelieved) {
  PoseEstimate pose = moving(3.8, 0);
  pose.valid = false;
  EXPECT_STREQ(markers.pass(0, pose, 0).refused, "no pose");
  EXPECT_STREQ(markers.pass(0, moving(3.8, 0), kNoZone).refused, "no pose");
  EXPECT_STREQ(markers.pass(2, moving(3.8, 0), 0).refused, "no such zone");
}

TEST_F(Markers, AreRefusedByNameWhereTheMapHasNoSuchZoneOrDoor) {
  const auto fault = [&](std::vector<ZoneMarkerSettings> wrong) {
    const auto fit = ZoneMarkers::check(graph, wrong);
    return fit ? "none" : fit.error().message;
  };
  EXPECT_EQ(fault({settings[0], settings[1]}), "none");
  EXPECT_EQ(fault({settings[2]}), "gpio.zone_markers.gone.zones: the map has no zone x");
  EXPECT_EQ(fault({{.name = "lab", .zone = "z", .other = ""}}),
            "gpio.zone_markers.lab.zones: the map has no zone z");
  EXPECT_EQ(fault({{.name = "wall", .zone = "a", .other = "c"}}).substr(0, 65),
            "gpio.zone_markers.wall.zones: no portal leads from a to c; name t");
}

}  // namespace
}  // namespace zonepack
