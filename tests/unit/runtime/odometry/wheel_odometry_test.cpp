// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kWheelMs = 1'000'000;

CanSignal big(std::uint32_t id, std::uint16_t start, std::uint16_t length) {
  CanSignal signal;
  signal.id = id;
  signal.bits = {start, length, ByteOrder::kBig};
  signal.type = SignalType::kSigned;
  signal.factor = 0.001;
  return signal;
}

WheelOdometrySettings agilex() {
  WheelOdometrySettings settings;
  settings.signals[0] = big(0x311, 7, 32);
  settings.signals[1] = big(0x311, 39, 32);
  settings.geometry.track_m = 0.4;
  return settings;
}

void put(CanFrame& frame, std::int64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) {
    frame.data[frame.len++] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

CanFrame positions(std::int64_t t_ms, std::int64_t left_mm, std::int64_t right_mm) {
  CanFrame frame;
  frame.id = 0x311;
  frame.stamp_ns = t_ms * kWheelMs;
  put(frame, left_mm, 4);
  put(frame, right_mm, 4);
  return frame;
}

TEST(WheelOdometry, TheFirstSampleOnlySetsTheStart) {
  WheelOdometry odometry(agilex());
  EXPECT_FALSE(odometry.newest_ns().has_value());
  EXPECT_TRUE(odometry.stale(0));
  EXPECT_FALSE(odometry.take(positions(1000, 123456, -99)).has_value());
  EXPECT_EQ(odometry.newest_ns(), 1000 * kWheelMs);
  EXPECT_FALSE(odometry.stale(1299 * kWheelMs));
  EXPECT_TRUE(odometry.stale(1301 * kWheelMs));
}

TEST(WheelOdometry, WheelPositionsBecomeAnArc) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, 1000, 5000));
  // Left 20 mm, right 40 mm, track 400 mm: 30 mm along, turn 20 / 400 = 0.05 rad, in 20 ms.
  const auto step = odometry.take(positions(20, 1020, 5040));
  ASSERT_TRUE(step.has_value());
  EXPECT_EQ(step->from_ns, 0);
  EXPECT_EQ(step->to_ns, 20 * kWheelMs);
  const Pose2 arc = along_arc(0.03, 0.05);
  EXPECT_DOUBLE_EQ(step->motion.pose.x_m, arc.x_m);
  EXPECT_DOUBLE_EQ(step->motion.pose.y_m, arc.y_m);
  EXPECT_DOUBLE_EQ(step->motion.pose.yaw_rad, 0.05);
  EXPECT_NEAR(step->speed_m_s, 1.5, 1e-12);
  EXPECT_NEAR(step->yaw_rate_rad_s, 2.5, 1e-12);
  EXPECT_GT(step->motion.covariance.xx, 0);
}

TEST(WheelOdometry, CountersMayWrapAnywhere) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, INT32_MAX - 5, INT32_MIN + 5));
  const auto step =
      odometry.take(positions(20, std::int64_t{INT32_MAX} + 5, std::int64_t{INT32_MIN} - 5));
  ASSERT_TRUE(step.has_value());
  // Left 10 mm forwards, right 10 mm backwards: a turn on the spot by -20 / 400.
  EXPECT_NEAR(step->motion.pose.x_m, 0, 1e-15);
  EXPECT_DOUBLE_EQ(step->motion.pose.yaw_rad, -0.05);
}

TEST(WheelOdometry, UncertaintyGrowsWithDistanceAndTurnAndNotAtRest) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, 0, 0));
  const auto standing = odometry.take(positions(20, 0, 0));
  EXPECT_EQ(standing->motion.covariance, Covariance2{});
  const auto slow = odometry.take(positions(40, 2, 2));
  const auto fast = odometry.take(positions(60, 6, 6));
  EXPECT_NEAR(fast->motion.covariance.xx, 2 * slow->motion.covariance.xx, 1e-18);
  const auto turn = odometry.take(positions(80, 4, 8));
  EXPECT_GT(turn->motion.covariance.yaw_yaw, fast->motion.covariance.yaw_yaw);
}

TEST(WheelOdometry, LostFramesLoseNoMotion) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, 0, 0));
  odometry.take(positions(20, 20, 20));
  const auto step = odometry.take(positions(120, 120, 120));
  ASSERT_TRUE(step.has_value());
  EXPECT_NEAR(step->motion.pose.x_m, 0.1, 1e-12);
  EXPECT_EQ(odometry.counters().gaps, 0u);
  EXPECT_EQ(odometry.counters().rejected, 0u);
}

TEST(WheelOdometry, AGapIsBridgedWithLessTrust) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, 0, 0));
  odometry.take(positions(20, 20, 20));
  const auto step = odometry.take(positions(2020, 2020, 2020));
  ASSERT_TRUE(step.has_value());
  EXPECT_NEAR(step->motion.pose.x_m, 2, 1e-12);
  EXPECT_GT(std::sqrt(step->motion.covariance.yy), 0.49);  // a quarter of 2 m
  EXPECT_EQ(odometry.counters().gaps, 1u);
}

TEST(WheelOdometry, RefusesFramesThatAreShortRequestsOrOld) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(100, 0, 0));
  CanFrame frame = positions(120, 1, 1);
  frame.len = 7;
  EXPECT_FALSE(odometry.take(frame).has_value());
  frame = positions(120, 1, 1);
  frame.rtr = true;
  EXPECT_FALSE(odometry.take(frame).has_value());
  EXPECT_FALSE(odometry.take(positions(100, 1, 1)).has_value());
  EXPECT_FALSE(odometry.take(positions(80, 1, 1)).has_value());
  frame = positions(120, 1, 1);
  frame.id = 0x312;  // not ours: not counted
  EXPECT_FALSE(odometry.take(frame).has_value());
  EXPECT_EQ(odometry.counters().frames, 5u);
  EXPECT_EQ(odometry.counters().rejected, 4u);
  EXPECT_TRUE(odometry.take(positions(120, 1, 1)).has_value());
}

TEST(WheelOdometry, FramesThatWereOvertakenAreRefusedHoweverManyComeInARow) {
  WheelOdometry odometry(agilex());
  for (int t : {0, 20, 40, 60, 80, 100}) odometry.take(positions(t, t, t));
  for (int t : {20, 40, 60, 80}) EXPECT_FALSE(odometry.take(positions(t, t, t)).has_value());
  const auto step = odometry.take(positions(120, 120, 120));
  ASSERT_TRUE(step.has_value());
  EXPECT_EQ(step->from_ns, 100 * kWheelMs);
  EXPECT_EQ(odometry.counters().rejected, 4u);
  EXPECT_EQ(odometry.counters().rebased, 0u);
}

TEST(WheelOdometry, ASinglePositionOutOfPlaceIsRefusedWithoutLosingMotion) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, 0, 0));
  odometry.take(positions(20, 20, 20));
  EXPECT_FALSE(odometry.take(positions(40, 5000, 40)).has_value());
  const auto step = odometry.take(positions(60, 60, 60));
  ASSERT_TRUE(step.has_value());
  EXPECT_EQ(step->from_ns, 20 * kWheelMs);
  EXPECT_NEAR(step->motion.pose.x_m, 0.04, 1e-12);
  EXPECT_EQ(odometry.counters().jumps, 1u);
  EXPECT_EQ(odometry.counters().rejected, 1u);
  EXPECT_EQ(odometry.counters().rebased, 0u);
}

TEST(WheelOdometry, AfterACounterResetItContinuesAndReportsMissingMotion) {
  WheelOdometry odometry(agilex());
  for (int i = 0; i <= 10; ++i) odometry.take(positions(20 * i, 90'000 + 20 * i, 90'000 + 20 * i));
  EXPECT_FALSE(odometry.take(positions(220, 0, 0)).has_value());
  const auto step = odometry.take(positions(240, 20, 20));
  ASSERT_TRUE(step.has_value());
  EXPECT_EQ(step->from_ns, 200 * kWheelMs);
  EXPECT_EQ(step->to_ns, 240 * kWheelMs);
  EXPECT_NEAR(step->motion.pose.x_m, 0.04, 1e-12);  // 20 mm seen, 20 mm assumed to be as before
  EXPECT_GT(std::sqrt(step->motion.covariance.xx), 0.009);  // 0.5 m/s for 20 ms
  EXPECT_EQ(odometry.counters().rebased, 1u);
  const auto next = odometry.take(positions(260, 40, 40));
  EXPECT_NEAR(next->motion.pose.x_m, 0.02, 1e-12);
  EXPECT_EQ(odometry.counters().rejected, 1u);
}

TEST(WheelOdometry, AnAbruptButLastingChangeOfSpeedIsBelievedInTheEnd) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(0, 0, 0));
  odometry.take(positions(20, 0, 0));
  // From standing to 1.5 m/s within one sample: 75 m/s2.
  EXPECT_FALSE(odometry.take(positions(40, 30, 30)).has_value());
  const auto step = odometry.take(positions(60, 60, 60));
  ASSERT_TRUE(step.has_value());
  EXPECT_NEAR(step->motion.pose.x_m, 0.06, 1e-12);
  EXPECT_EQ(odometry.counters().rebased, 0u);
}

TEST(WheelOdometry, ContinuesWhenTheClockWasSetBack) {
  WheelOdometry odometry(agilex());
  odometry.take(positions(100'000, 0, 0));
  odometry.take(positions(100'020, 20, 20));
  EXPECT_FALSE(odometry.take(positions(5'000, 40, 40)).has_value());
  const auto step = odometry.take(positions(5'020, 60, 60));
  ASSERT_TRUE(step.has_value());
  EXPECT_EQ(step->to_ns, 5'020 * kWheelMs);
  EXPECT_TRUE(odometry.take(positions(5'040, 80, 80)).has_value());
  EXPECT_EQ(odometry.counters().rebased, 1u);
}

TEST(WheelOdometry, WheelsInFramesOfTheirOwnArePaired) {
  WheelOdometrySettings settings = agilex();
  settings.signals[1] = big(0x312, 7, 32);
  WheelOdometry odometry(settings);
  const auto one = [](std::uint32_t id, std::int64_t t_ms, std::int64_t mm) {
    CanFrame frame;
    frame.id = id;
    frame.stamp_ns = t_ms * kWheelMs;
    put(frame, mm, 4);
    return frame;
  };
  EXPECT_FALSE(odometry.take(one(0x311, 0, 0)));
  EXPECT_FALSE(odometry.take(one(0x312, 1, 0)));
  EXPECT_FALSE(odometry.take(one(0x311, 20, 20)));
  const auto step = odometry.take(one(0x312, 21, 20));
  ASSERT_TRUE(step.has_value());
  EXPECT_EQ(step->to_ns, 21 * kWheelMs);
  EXPECT_NEAR(step->motion.pose.x_m, 0.02, 1e-12);
  // The right wheel is missing once: the next pair bridges it.
  EXPECT_FALSE(odometry.take(one(0x311, 40, 40)));
  EXPECT_FALSE(odometry.take(one(0x311, 60, 60)));
  EXPECT_NEAR(odometry.take(one(0x312, 61, 60))->motion.pose.x_m, 0.04, 1e-12);
}

TEST(WheelOdometry, WheelSpeedsAndTwistsAreIntegrated) {
  WheelOdometrySettings speeds = agilex();
  speeds.model = OdometryModel::kWheelSpeeds;
  speeds.metres_per_unit = {0.14, 0.14};  // rad/s of a wheel of that radius
  WheelOdometry wheels(speeds);
  wheels.take(positions(0, 5000, 5000));
  const auto rolled = wheels.take(positions(20, 5000, 6000));
  // Right: mean of 5 and 6 rad/s * 0.14 m * 20 ms = 15.4 mm, left 14 mm; turn 1.4 / 400.
  EXPECT_NEAR(rolled->motion.pose.yaw_rad, 0.0035, 1e-12);
  EXPECT_NEAR(rolled->speed_m_s, 0.735, 1e-12);

  WheelOdometrySettings twist = agilex();
  twist.model = OdometryModel::kTwist;
  twist.signals[0] = big(0x221, 7, 16);
  twist.signals[1] = big(0x221, 23, 16);
  WheelOdometry turned(twist);
  const auto frame = [](std::int64_t t_ms, int speed, int rate) {
    CanFrame made;
    made.id = 0x221;
    made.stamp_ns = t_ms * kWheelMs;
    put(made, speed, 2);
    put(made, rate, 2);
    return made;
  };
  turned.take(frame(0, 1000, -500));
  const auto step = turned.take(frame(100, 1000, -500));
  const Pose2 arc = along_arc(0.1, -0.05);
  EXPECT_NEAR(step->motion.pose.x_m, arc.x_m, 1e-12);
  EXPECT_NEAR(step->motion.pose.y_m, arc.y_m, 1e-12);
  EXPECT_FALSE(turned.take(frame(120, 20'000, 0)).has_value());  // 20 m/s
  EXPECT_EQ(turned.counters().jumps, 1u);
}

TEST(WheelOdometry, AFullCircleEndsWhereItBegan) {
  WheelOdometry odometry(agilex());
  Pose2 pose;
  // Radius 1 m, 2000 steps: wheels run 0.8 and 1.2 of the distance.
  for (int i = 0; i <= 2000; ++i) {
    const double way_mm = 2000 * kPi * i / 2000;
    const auto step =
        odometry.take(positions(20 * i, std::lround(0.8 * way_mm), std::lround(1.2 * way_mm)));
    if (step) pose = compose(pose, step->motion.pose);
  }
  EXPECT_NEAR(pose.x_m, 0, 0.005);
  EXPECT_NEAR(pose.y_m, 0, 0.005);
  EXPECT_NEAR(pose.yaw_rad, 0, 0.005);
}

}  // namespace
}  // namespace zonepack
