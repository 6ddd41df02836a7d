// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_trim.hpp"

#include <gtest/gtest.h>

#include "runtime/odometry/pose_filter.hpp"

namespace zonepack {
namespace {

// A history of steps without noise, 0.1 s each, and fixes with sigmas of 1 cm and 2 mrad.
struct Learner {
  explicit Learner(const Pose2& step, int steps = 20) {
    history.restart(0);
    for (int i = 1; i <= steps; ++i) history.push(i * std::int64_t{100'000'000}, {step, {}});
  }
  void fix(const Pose2& pose, std::uint64_t index) {
    trim.learn(history, {pose, {1e-4, 0, 0, 1e-4, 0, 4e-6}}, history.oldest() + index);
  }
  OdometryHistory history{64};
  WheelTrim trim;
};

// Variance of the way 0.0025 * 2^2 = 0.01, of its measurement 2 * 0.01^2 + 0.02^2 = 0.0006: a gain
// of 0.0025 * 2 / 0.0106 = 0.4717 for the 0.1 m that are missing.
TEST(WheelTrim, LearnsTheWayFromTwoFixes) {
  Learner learner({0.1, 0, 0});
  learner.fix({5, 5, 0}, 0);
  learner.fix({7.1, 5, 0}, 20);
  EXPECT_EQ(learner.trim.pairs(), 1u);
  EXPECT_NEAR(learner.trim.way(), 1.04717, 1e-5);
  EXPECT_EQ(learner.trim.turn(), 1);
}

// 1 rad reported, 0.95 real: 1 - 0.05 * 0.0025 / (0.0025 + 2 * 0.002^2 + 0.002^2).
TEST(WheelTrim, LearnsTheTurn) {
  Learner learner({0, 0, 0.05});
  learner.fix({5, 5, 3}, 0);
  learner.fix({5, 5, 3.95 - 2 * 3.14159265358979}, 20);
  EXPECT_NEAR(learner.trim.turn(), 0.950239, 1e-6);
  EXPECT_EQ(learner.trim.way(), 1);
}

TEST(WheelTrim, AppliesWhatItLearnedAndNothingBefore) {
  OdometryIncrement increment;
  increment.motion.pose = {1, 0.5, 0.25};
  increment.speed_m_s = 2;
  increment.yaw_rate_rad_s = 4;
  Learner learner({0.1, 0, 0});
  EXPECT_EQ(learner.trim.trimmed(increment).motion.pose, increment.motion.pose);
  learner.fix({5, 5, 0}, 0);
  learner.fix({7.1, 5, 0}, 20);
  const OdometryIncrement trimmed = learner.trim.trimmed(increment);
  EXPECT_NEAR(trimmed.motion.pose.x_m, 1.04717, 1e-5);
  EXPECT_NEAR(trimmed.motion.pose.y_m, 0.52358, 1e-5);
  EXPECT_EQ(trimmed.motion.pose.yaw_rad, 0.25);
  EXPECT_NEAR(trimmed.speed_m_s, 2.09434, 1e-5);
  EXPECT_EQ(trimmed.yaw_rate_rad_s, 4);
}

// 3 m instead of 2: over 3 * sqrt(0.0106) = 0.31 m off. The turn of 0 still agrees.
TEST(WheelTrim, LeavesOutWhatWheelsCannotHaveDone) {
  Learner learner({0.1, 0, 0});
  learner.fix({5, 5, 0}, 0);
  learner.fix({8, 5, 0}, 20);
  EXPECT_EQ(learner.trim.way(), 1);
}

TEST(WheelTrim, WaitsForAWayOrATurnThatSaysSomething) {
  Learner learner({0.1, 0, 0});
  learner.fix({5, 5, 0}, 0);
  learner.fix({6.1, 5, 0}, 10);  // 1 m: too short
  EXPECT_EQ(learner.trim.pairs(), 0u);
  learner.fix({7.1, 5, 0}, 20);  // 2 m since the first
  EXPECT_EQ(learner.trim.pairs(), 1u);
  EXPECT_NEAR(learner.trim.way(), 1.04717, 1e-5);
}

TEST(WheelTrim, TakesNothingFromAWayThatOdometryMissed) {
  Learner learner({0.1, 0, 0});
  learner.history.at(learner.history.oldest() + 7).drift = true;
  learner.fix({5, 5, 0}, 0);
  learner.fix({7.1, 5, 0}, 20);
  EXPECT_EQ(learner.trim.pairs(), 0u);
}

// Wheels that report 5 % too much, a fix every 0.5 s for 60 s: only those of a localizer that sees
// teach the filter.
TEST(WheelTrim, IsTaughtThroughTheFilterByFixesWithAView) {
  for (const double view_m : {0.0, 10.0}) {
    PoseFilter filter({});
    Pose2 truth;
    for (int i = 1; i <= 3000; ++i) {
      const std::int64_t now = i * std::int64_t{20'000'000};
      truth = compose(truth, along_arc(0.02, 0.005));
      OdometryIncrement increment;
      increment.from_ns = now - 20'000'000;
      increment.to_ns = now;
      increment.motion = {along_arc(0.021, 0.00525), {2e-6, 0, 0, 5e-7, 0, 2e-6}};
      filter.predict(increment);
      if (i % 25 == 0) filter.correct({now, now, truth, 0.02, 0.02, 0.005, view_m}, now);
    }
    EXPECT_EQ(filter.wheel_trim().pairs() > 0, view_m > 0);
    EXPECT_NEAR(filter.wheel_trim().way(), view_m > 0 ? 1 / 1.05 : 1, 0.004);
    EXPECT_NEAR(filter.wheel_trim().turn(), view_m > 0 ? 1 / 1.05 : 1, 0.004);
  }
}

}  // namespace
}  // namespace zonepack
