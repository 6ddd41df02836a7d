// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/solve/planar_ransac.hpp"

#include <gtest/gtest.h>

#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

const Pose2 kPose{3, -2, 0.7};

TEST(PlanarRansac, FindsThePoseFromTwoSightings) {
  const CameraModel camera = made_camera();
  // A point on the floor 2 m before the camera and 0.5 m below it, straight ahead:
  // (3 + 2.2 cos 0.7, -2 + 2.2 sin 0.7, 0) is seen 385 * 0.5 / 2 = 96.25 px below the middle. One
  // 1 m to the left of it is seen 385 / 2 = 192.5 px to the left.
  const double c = std::cos(0.7), s = std::sin(0.7);
  Sighting a, b;
  a.p_map = {3 + 2.2 * c, -2 + 2.2 * s, 0};
  a.px = {319.5, 239.5 + 96.25};
  b.p_map = {3 + 2.2 * c - s, -2 + 2.2 * s + c, 0};
  b.px = {319.5 - 192.5, 239.5 + 96.25};
  b.feature = 1;
  const auto pose = pose_of_two(a, b, camera, 0, {3.2, -1.9, 0.6});
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->x_m, 3, 1e-3);
  EXPECT_NEAR(pose->y_m, -2, 1e-3);
  EXPECT_NEAR(pose->yaw_rad, 0.7, 1e-3);
}

TEST(PlanarRansac, FindsThePoseAmongAsManyWrongSightings) {
  const CameraModel camera = made_camera();
  std::vector<Sighting> sightings = made_sightings(camera, lift(kPose, 0.05), 60);
  spoil(sightings, 2);
  const auto poses = find_planar(sightings, camera, 0.05, {{3.3, -2.2, 0.6}, 1, 0.3}, {});
  ASSERT_FALSE(poses.empty());
  EXPECT_NEAR(poses[0].pose.x_m, 3, 0.01);
  EXPECT_NEAR(poses[0].pose.y_m, -2, 0.01);
  EXPECT_NEAR(poses[0].pose.yaw_rad, 0.7, 0.005);
  EXPECT_GE(poses[0].features, 30);
}

TEST(PlanarRansac, LeavesNoGate) {
  const CameraModel camera = made_camera();
  const std::vector<Sighting> sightings = made_sightings(camera, lift(kPose, 0), 40);
  EXPECT_TRUE(find_planar(sightings, camera, 0, {{6, -2, 0.7}, 1, 0.3}, {}).empty());
  EXPECT_TRUE(find_planar(sightings, camera, 0, {{3, -2, 1.7}, 1, 0.3}, {}).empty());
}

TEST(PlanarRansac, GivesTheSameForTheSameSeed) {
  const CameraModel camera = made_camera();
  std::vector<Sighting> sightings = made_sightings(camera, lift(kPose, 0), 50);
  spoil(sightings, 3);
  const PoseGate gate{{3.1, -2.1, 0.65}, 1, 0.3};
  const auto once = find_planar(sightings, camera, 0, gate, {});
  const auto again = find_planar(sightings, camera, 0, gate, {});
  ASSERT_FALSE(once.empty());
  EXPECT_EQ(once[0].pose, again[0].pose);
}

}  // namespace
}  // namespace zonepack::localize
