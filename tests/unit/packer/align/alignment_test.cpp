// SPDX-License-Identifier: Apache-2.0
#include "packer/align/alignment.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180;

// A robot's base at the corners of a square of 4 m, each time turned a quarter, and the camera that
// it carries 0.2 m ahead and 0.5 m up.
class AlignmentTest : public ::testing::Test {
 protected:
  AlignmentTest() {
    placement_.camera_in_base = {0.2, 0, 0.5, 0, 0, 0};
    mount_ = optical_in_base(*placement_.camera_in_base);
    const double corners[4][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
    for (int i = 0; i < 4; ++i) {
      bases_.push_back(Eigen::Translation3d(10 + corners[i][0], 20 + corners[i][1], 0) *
                       Eigen::AngleAxisd(90 * i * kDegree, Vector3d::UnitZ()));
    }
  }

  // As a SLAM system has them that begins at the first camera and measures in units of 2 m.
  std::vector<KeyframePose> keyframes() const {
    std::vector<KeyframePose> out;
    const Isometry3d first = bases_[0] * mount_;
    for (std::size_t i = 0; i < bases_.size(); ++i) {
      Isometry3d T = first.inverse() * (bases_[i] * mount_);
      T.translation() /= 2;
      out.push_back({100.0 + static_cast<double>(i), T});
    }
    return out;
  }

  void write_trajectory() {
    placement_.trajectory = folder_ / "base.txt";
    std::ofstream out(placement_.trajectory);
    for (std::size_t i = 0; i < bases_.size(); ++i) {
      const Eigen::Quaterniond q(bases_[i].linear());
      const Vector3d p = bases_[i].translation();
      out << 100 + i << " " << p.x() << " " << p.y() << " " << p.z() << " " << q.x() << " " << q.y()
          << " " << q.z() << " " << q.w() << "\n";
    }
  }

  static double off_m(const Alignment& found, const KeyframePose& keyframe,
                      const Isometry3d& base) {
    const Isometry3d T =
        found.into_map.pose(keyframe.T_world_camera) * found.T_base_camera.inverse();
    return (T.translation() - base.translation()).norm() + (T.linear() - base.linear()).norm();
  }

  std::string error_of(const std::vector<KeyframePose>& poses) const {
    try {
      align_keyframes(poses, placement_, false, "map.msg");
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  test_support::TemporaryFolder folder_;
  Placement placement_;
  Isometry3d mount_;
  std::vector<Isometry3d> bases_;
};

// The camera looks along x: its right is the base's -y, its down the base's -z.
TEST(Alignment, ACameraWithoutRotationLooksForward) {
  const Isometry3d T = optical_in_base({0.1, 0.2, 0.3, 0, 0, 0});
  EXPECT_TRUE(T.linear().col(2).isApprox(Vector3d::UnitX()));
  EXPECT_TRUE(T.linear().col(0).isApprox(-Vector3d::UnitY()));
  EXPECT_TRUE(T.linear().col(1).isApprox(-Vector3d::UnitZ()));
  EXPECT_TRUE(T.translation().isApprox(Vector3d(0.1, 0.2, 0.3)));
}

TEST(Alignment, TheAnglesOfACameraComeBack) {
  const std::array<double, 6> mount = camera_in_base(optical_in_base({1, 2, 3, 10, -20, 30}));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(mount[i], (std::array<double, 6>{1, 2, 3, 10, -20, 30})[i], 1e-9) << i;
  }
}

TEST_F(AlignmentTest, ATrajectoryGivesPlaceLevelAndScale) {
  write_trajectory();
  const auto poses = keyframes();
  const Alignment found = align_keyframes(poses, placement_, false, "map.msg");
  EXPECT_NEAR(found.into_map.metres_per_unit, 2, 1e-6);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_LT(off_m(found, poses[i], bases_[i]), 1e-4);
  EXPECT_THAT(found.notes,
              ElementsAre(HasSubstr("4 of 4 keyframes, 1 unit is 2 m, residuals p50")));
  EXPECT_TRUE(found.warnings.empty());
}

TEST_F(AlignmentTest, ATrajectoryGivesTheTurnOfACameraThatNobodyStated) {
  placement_.camera_in_base = {0.2, 0, 0.5, 0, 15, 0};
  mount_ = optical_in_base(*placement_.camera_in_base);
  write_trajectory();
  placement_.camera_in_base.reset();
  const Alignment found = align_keyframes(keyframes(), placement_, false, "map.msg");
  EXPECT_NEAR(camera_in_base(found.T_base_camera)[4], 15, 1e-6);
}

// A mount in the words of the optical frame (-90, 0, -90) would turn every pose of the robot.
TEST_F(AlignmentTest, AMountThatTheTrajectoryContradictsIsWarnedOf) {
  write_trajectory();
  placement_.camera_in_base = {0.2, 0, 0.5, -90, 0, -90};
  const Alignment found = align_keyframes(keyframes(), placement_, false, "map.msg");
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("turns the camera 120 degrees away")));
  EXPECT_THAT(found.warnings[0], HasSubstr("--camera-in-base 0.2,0,0.5,0,0,0"));
}

TEST_F(AlignmentTest, APlaceFarOffDoesNotBendTheOthers) {
  for (int i = 0; i < 4; ++i) bases_.push_back(Eigen::Translation3d(1, i, 0) * bases_[0]);
  write_trajectory();
  auto poses = keyframes();
  poses[2].T_world_camera.translation() += Vector3d(0, 0, 5);
  const Alignment found = align_keyframes(poses, placement_, false, "map.msg");
  EXPECT_LT(off_m(found, poses[1], bases_[1]), 1e-3);
}

TEST_F(AlignmentTest, KeyframesOnALineAreRefused) {
  for (std::size_t i = 0; i < bases_.size(); ++i) bases_[i] = Eigen::Translation3d(double(i), 0, 0);
  write_trajectory();
  EXPECT_THAT(error_of(keyframes()), HasSubstr("stand on a line"));
}

TEST_F(AlignmentTest, ATrajectoryOfAnotherDayIsRefusedWithBothTimes) {
  write_trajectory();
  auto poses = keyframes();
  for (KeyframePose& pose : poses) pose.stamp_s += 86400;
  EXPECT_THAT(error_of(poses), HasSubstr("covers 0 of the 4 keyframes of map.msg"));
  EXPECT_THAT(error_of(poses), HasSubstr("from 100.000 to 103.000, the keyframes' from 86500.000"));
}

// Without a trajectory the map begins at the first base: x forward, z up, 2 m a unit.
TEST_F(AlignmentTest, ScaleAndPlaneGiveAMapThatBeginsAtTheFirstBase) {
  placement_.metres_per_unit = 2;
  const auto poses = keyframes();
  const Alignment found = align_keyframes(poses, placement_, false, "map.msg");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(off_m(found, poses[i], Eigen::Translation3d(-10, -20, 0) * bases_[i]), 1e-9);
  }
  EXPECT_TRUE(found.warnings.empty());
}

TEST_F(AlignmentTest, TheUnitOfOneCameraIsNotKnown) {
  const Alignment one = align_keyframes(keyframes(), placement_, false, "map.msg");
  EXPECT_THAT(one.warnings, ElementsAre(HasSubstr("--scale METRES or --align TRAJECTORY")));
  EXPECT_TRUE(align_keyframes(keyframes(), placement_, true, "map.msg").warnings.empty());
}

TEST_F(AlignmentTest, UpMayBeGiven) {
  placement_.up = {0, -3, 0};  // the first camera's top
  const Alignment found = align_keyframes(keyframes(), placement_, true, "map.msg");
  EXPECT_TRUE((found.into_map.R_map_world * Vector3d(0, -1, 0)).isApprox(Vector3d::UnitZ()));
}

}  // namespace
}  // namespace zonepack::packer
