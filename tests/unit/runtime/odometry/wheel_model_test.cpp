// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

using Model = OdometryModel;

void expect_motion(const BodyMotion& motion, double forward, double sideways, double turn) {
  EXPECT_NEAR(motion.forward_m, forward, 1e-12);
  EXPECT_NEAR(motion.sideways_m, sideways, 1e-12);
  EXPECT_NEAR(motion.turn_rad, turn, 1e-12);
}

TEST(WheelModel, TwoWheelsGoAlongTheirMeanAndTurnByTheirDifference) {
  WheelGeometry geometry;
  geometry.track_m = 0.5;
  const WheelModel model(Model::kDifferentialPositions, geometry);
  EXPECT_EQ(model.signals(), 2u);
  // Left 0.1 m, right 0.2 m: middle 0.15 m, turn 0.1 / 0.5.
  expect_motion(model.motion({0.1, 0.2}), 0.15, 0, 0.2);
}

TEST(WheelModel, SkiddingTakesMoreOfTheWheelsForATurn) {
  WheelGeometry geometry;
  geometry.track_m = 0.5;
  geometry.slip_factor = 1.6;
  // 0.1 m of difference over 0.5 m * 1.6: 0.125 rad.
  expect_motion(WheelModel(Model::kWheelSpeeds, geometry).motion({0.1, 0.2}), 0.15, 0, 0.125);
  // Straight on nothing changes.
  expect_motion(WheelModel(Model::kWheelSpeeds, geometry).motion({0.2, 0.2}), 0.2, 0, 0);
}

TEST(WheelModel, ASteeredAxleTurnsByTheTangentOfItsAngle) {
  WheelGeometry geometry;
  geometry.wheelbase_m = 0.8;
  const WheelModel model(Model::kAckermannSpeeds, geometry);
  EXPECT_EQ(model.signals(), 2u);
  EXPECT_EQ(model.wheels(), 1u);
  // tan(45 degrees) = 1: 1 m/s over 0.8 m.
  expect_motion(model.motion({1, kPi / 4}), 1, 0, 1.25);
  // tan(atan(0.4)) = 0.4: a circle of 2 m radius, backwards and to the right.
  expect_motion(model.motion({-0.5, std::atan(0.4)}), -0.5, 0, -0.25);
  expect_motion(model.motion({1, 0}), 1, 0, 0);
}

// The wheels of a mecanum robot, from its motion: fl = vx - vy - k w, fr = vx + vy + k w,
// rl = vx + vy - k w, rr = vx - vy + k w, k = (track + wheelbase) / 2.
TEST(WheelModel, MecanumWheelsGiveAllThreeDirections) {
  WheelGeometry geometry;
  geometry.track_m = 0.4;
  geometry.wheelbase_m = 0.6;
  const WheelModel model(Model::kMecanumSpeeds, geometry);
  EXPECT_EQ(model.signals(), 4u);
  expect_motion(model.motion({1, 1, 1, 1}), 1, 0, 0);
  // To the left at 0.3 m/s: front left and rear right turn backwards.
  expect_motion(model.motion({-0.3, 0.3, 0.3, -0.3}), 0, 0.3, 0);
  // 2 rad/s on the spot: k = 0.5, so 1 m/s at each wheel, left backwards.
  expect_motion(model.motion({-1, 1, -1, 1}), 0, 0, 2);
  // 0.5 ahead, 0.2 to the right, -0.4 rad/s: k w = -0.2.
  expect_motion(model.motion({0.5 + 0.2 + 0.2, 0.5 - 0.2 - 0.2, 0.5 - 0.2 + 0.2, 0.5 + 0.2 - 0.2}),
                0.5, -0.2, -0.4);
}

TEST(WheelModel, ThreeOmniWheelsGiveAllThreeDirections) {
  WheelGeometry geometry;
  geometry.omni_radius_m = 0.2;
  geometry.omni_bearing_rad = 0;  // first wheel ahead: it rolls to the left
  const WheelModel model(Model::kOmniSpeeds, geometry);
  EXPECT_EQ(model.signals(), 3u);
  // A wheel at bearing b sees w = -sin(b) vx + cos(b) vy + r turn. sin(120) = 0.8660254, cos =
  // -0.5.
  const double s = std::sqrt(3) / 2;
  expect_motion(model.motion({0, -s, s}), 1, 0, 0);
  expect_motion(model.motion({1, -0.5, -0.5}), 0, 1, 0);
  expect_motion(model.motion({0.2, 0.2, 0.2}), 0, 0, 1);
}

TEST(WheelModel, FourOmniWheelsAtAnyBearingReturnTheMotion) {
  WheelGeometry geometry;
  geometry.omni_radius_m = 0.3;
  geometry.omni_wheels = 4;
  for (double bearing : {0.0, 0.785, -1.9, 3.0}) {
    geometry.omni_bearing_rad = bearing;
    const WheelModel model(Model::kOmniPositions, geometry);
    PerWheel ways{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double b = bearing + kPi / 2 * static_cast<double>(i);
      ways[i] = -std::sin(b) * 0.7 + std::cos(b) * -0.2 + 0.3 * 0.5;
    }
    expect_motion(model.motion(ways), 0.7, -0.2, 0.5);
  }
}

TEST(WheelModel, KnowsWhichModelsReadPositions) {
  EXPECT_TRUE(reads_positions(Model::kDifferentialPositions));
  EXPECT_TRUE(reads_positions(Model::kOmniPositions));
  EXPECT_FALSE(reads_positions(Model::kWheelSpeeds));
  EXPECT_FALSE(reads_positions(Model::kTwist));
  EXPECT_FALSE(reads_positions(Model::kAckermannSpeeds));
}

}  // namespace
}  // namespace zonepack
