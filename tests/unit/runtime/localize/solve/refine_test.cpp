// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/solve/refine.hpp"

#include <gtest/gtest.h>

#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

TEST(Refine, FindsTheExactPoseAmongWrongSightings) {
  const CameraModel camera = made_camera();
  const Eigen::Isometry3d truth = lift({3, -2, 0.7}, 0);
  std::vector<Sighting> sightings = made_sightings(camera, truth, 60);
  spoil(sightings, 3);
  const Refined refined = refine(sightings, camera, lift({3.02, -2.01, 0.705}, 0), {});
  ASSERT_TRUE(refined.valid);
  EXPECT_LT((refined.T_map_base.translation() - truth.translation()).norm(), 1e-4);
  EXPECT_NEAR(flatten(refined.T_map_base).yaw_rad, 0.7, 1e-5);
}

TEST(Refine, LetsAMountBeADegreeOff) {
  // The robot leans by 1 degree; the prior of 0.7 degrees gives way to 60 sightings.
  const CameraModel camera = made_camera();
  Eigen::Isometry3d truth = lift({3, -2, 0.7}, 0);
  truth.linear() =
      truth.linear() * Eigen::AngleAxisd(0.01745, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const std::vector<Sighting> sightings = made_sightings(camera, truth, 60);
  const Refined refined = refine(sightings, camera, lift({3, -2, 0.7}, 0), {});
  ASSERT_TRUE(refined.valid);
  EXPECT_LT((refined.T_map_base.translation() - truth.translation()).norm(), 0.005);
}

TEST(Refine, IsLessSureWithFewerSightings) {
  // A quarter of the sightings: twice the standard deviation, about.
  const CameraModel camera = made_camera();
  const Eigen::Isometry3d truth = lift({3, -2, 0.7}, 0);
  const std::vector<Sighting> all = made_sightings(camera, truth, 80);
  const Refined many = refine(all, camera, truth, {});
  const Refined few = refine(std::span(all).first(20), camera, truth, {});
  ASSERT_TRUE(many.valid);
  ASSERT_TRUE(few.valid);
  EXPECT_GT(few.covariance.yaw_yaw, 2 * many.covariance.yaw_yaw);
  EXPECT_LT(few.covariance.yaw_yaw, 8 * many.covariance.yaw_yaw);
}

}  // namespace
}  // namespace zonepack::localize
