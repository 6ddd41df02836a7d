// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/expected_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/calibrate/expectation_hints.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Two wheels of 0.1 m radius, 0.5 m apart, that count motor turns.
Settings robot() {
  Settings settings;
  OdometrySettings& o = settings.odometry;
  o.left = "l";
  o.right = "r";
  o.unit = WheelUnit::kTurns;
  o.wheel_radius_m = 0.1;
  o.wheels.geometry.track_m = 0.5;
  return settings;
}

std::vector<WheelHint> hints_of(const Settings& settings, const std::string& expected, double left,
                                double right) {
  const auto motion = parse_expected_motion(expected);
  EXPECT_TRUE(motion) << expected;
  return expectation_hints(
      settings, *motion,
      {{{"left", "l"}, left, left != 0, true}, {{"right", "r"}, right, right != 0, true}});
}

TEST(ExpectedMotion, IsAWordAndPerhapsAnAmount) {
  EXPECT_EQ(parse_expected_motion("forward")->amount, std::nullopt);
  EXPECT_EQ(parse_expected_motion("left=90")->amount, 90);
  EXPECT_EQ(parse_expected_motion("right-wheel=0.5")->kind, ExpectedMotion::Kind::kRightWheel);
  for (const char* text : {"", "up", "forward=", "forward=-1", "forward=0", "left=90deg",
                           "left=nan", "left=inf", "forward=1e9", "leftt"}) {
    EXPECT_FALSE(parse_expected_motion(text)) << text;
  }
  EXPECT_EQ(instruction_text(*parse_expected_motion("backward=2")), "drive 2 m backward");
  EXPECT_EQ(instruction_text(*parse_expected_motion("left-wheel")),
            "turn the left wheel, and only it, forward by hand");
}

TEST(ExpectedMotion, WhatComesAsExpectedGivesNoHint) {
  EXPECT_THAT(hints_of(robot(), "forward=2", 2, 2.02), IsEmpty());
  EXPECT_THAT(hints_of(robot(), "backward", -1, -1), IsEmpty());
  // 90 degrees are 1.5708 rad * 0.25 m = 0.3927 m at each wheel.
  EXPECT_THAT(hints_of(robot(), "left=90", -0.3927, 0.3927), IsEmpty());
  EXPECT_THAT(hints_of(robot(), "right", 0.3, -0.3), IsEmpty());
  // A turn of a wheel is 2 pi 0.1 m = 0.6283 m.
  EXPECT_THAT(hints_of(robot(), "left-wheel=1", 0.6283, 0), IsEmpty());
}

TEST(ExpectedMotion, ForwardTellsWhichWheelCountsBackwards) {
  EXPECT_THAT(hints_of(robot(), "forward", -1, 1)[0].yaml,
              ElementsAre("odometry:", "  invert: [left]"));
  EXPECT_THAT(hints_of(robot(), "backward", -1, 1)[0].yaml,
              ElementsAre("odometry:", "  invert: [right]"));
  EXPECT_THAT(hints_of(robot(), "forward", -1, -1)[0].yaml,
              ElementsAre("odometry:", "  invert: [left, right]"));
}

TEST(ExpectedMotion, ATurnTellsWhichWheelIsWhich) {
  const auto hints = hints_of(robot(), "left", 0.3, -0.3);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints[0].kind, "swapped");
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  left: r", "  right: l"));
  // Both forward in a turn to the left: the left wheel should have gone back.
  EXPECT_THAT(hints_of(robot(), "left", 0.3, 0.3)[0].yaml,
              ElementsAre("odometry:", "  invert: [left]"));
}

TEST(ExpectedMotion, AWheelTurnedByHandTellsSideSignAndGear) {
  // The left wheel's turn arrives as 20 turns backwards of the signal named right.
  const auto hints = hints_of(robot(), "left-wheel=1", 0, -0.6283 * 20);
  ASSERT_EQ(hints.size(), 3u);
  EXPECT_EQ(hints[0].kind, "swapped");
  EXPECT_EQ(hints[1].kind, "sign");
  EXPECT_THAT(hints[1].yaml,
              ElementsAre("odometry:", "  left: r", "  right: l", "  invert: [left]"));
  EXPECT_EQ(hints[2].kind, "gear");
  EXPECT_THAT(hints[2].yaml, ElementsAre("odometry:", "  gear: 20"));
}

TEST(ExpectedMotion, AMeasuredWayGivesTheRadius) {
  // 2.2 m reported of 2 m: 0.1 m / 1.1 = 0.0909 m.
  EXPECT_THAT(hints_of(robot(), "forward=2", 2.2, 2.2)[0].yaml,
              ElementsAre("odometry:", "  wheel_radius: 0.09091"));
  // 120 degrees reported of 90: 0.5 m * 120 / 90.
  EXPECT_THAT(hints_of(robot(), "left=90", -0.5236, 0.5236)[0].yaml,
              ElementsAre("odometry:", "  track: 0.6667"));
}

TEST(ExpectedMotion, AWheelThatStandsIsNamed) {
  const auto hints = hints_of(robot(), "forward", 1, 0);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints[0].kind, "silent");
  EXPECT_EQ(hints[0].text, "odometry.right (r) did not move (expected: drive forward)");
}

TEST(ExpectedMotion, OfATwistIsItsSpeedOrItsYawRate) {
  Settings settings = robot();
  OdometrySettings& o = settings.odometry;
  o.wheels.model = OdometryModel::kTwist;
  o.unit = WheelUnit::kMetres;
  o.forward = "v";
  o.yaw_rate = "w";
  const std::vector<SignalMove> moves = {{{"forward", "v"}, 3.6, true, true},
                                         {{"yaw_rate", "w"}, -90, true, true}};
  // 3.6 for 1: km/h. 90 for pi / 2 rad: degrees, and the other way round.
  auto hints = expectation_hints(settings, *parse_expected_motion("forward=1"), moves);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  unit: km/h"));
  hints = expectation_hints(settings, *parse_expected_motion("left=90"), moves);
  ASSERT_EQ(hints.size(), 2u);
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  invert: [yaw_rate]"));
  EXPECT_THAT(hints[1].yaml, ElementsAre("odometry:", "  angle_unit: degrees"));
}

}  // namespace
}  // namespace zonepack
