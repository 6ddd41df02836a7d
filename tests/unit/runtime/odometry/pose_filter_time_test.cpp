// SPDX-License-Identifier: Apache-2.0
// Late fixes, missing odometry, clocks.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "runtime/odometry/pose_filter.hpp"
#include "tests/unit/runtime/odometry/simulated_drive.hpp"

namespace zonepack {
namespace {

using TimedVerdict = CorrectionVerdict;

// The same result as if the fix had not been late, bit for bit.
TEST(PoseFilterTime, ALateFixActsAtItsStamp) {
  SimulatedDrive in_time, late;
  in_time.trust();
  late.trust();
  const std::int64_t stamp = in_time.now();
  EXPECT_EQ(in_time.correct(stamp, 0.05, -0.02, 0.01), TimedVerdict::kUsed);
  in_time.steps(60);
  const PoseCorrection fix = late.fix(stamp, 0.05, -0.02, 0.01);
  late.steps(60);
  EXPECT_EQ(late.filter.correct(fix, late.now()), TimedVerdict::kUsed);
  const PoseEstimate a = in_time.filter.estimate(in_time.now());
  const PoseEstimate b = late.filter.estimate(late.now());
  EXPECT_EQ(a.T_map_base, b.T_map_base);
  EXPECT_EQ(a.covariance, b.covariance);
}

TEST(PoseFilterTime, FixesThatOvertakeEachOtherGiveTheSameResult) {
  SimulatedDrive sorted, crossed;
  sorted.trust();
  crossed.trust();
  const std::int64_t first = sorted.now();
  sorted.correct_now(0.04, 0, 0);
  sorted.steps(10);
  crossed.steps(10);
  sorted.correct_now(-0.03, 0.02, 0);
  EXPECT_EQ(crossed.correct_now(-0.03, 0.02, 0), TimedVerdict::kUsed);
  sorted.steps(10);
  crossed.steps(10);
  EXPECT_EQ(crossed.correct(first, 0.04, 0, 0), TimedVerdict::kUsed);
  EXPECT_EQ(sorted.filter.estimate(sorted.now()).T_map_base,
            crossed.filter.estimate(crossed.now()).T_map_base);
}

TEST(PoseFilterTime, AFixBetweenTwoSamplesIsCarriedAlongTheArc) {
  SimulatedDrive drive;
  drive.trust();
  drive.step(0.04, 0.1);
  drive.step(0.04, 0.1);
  // The pose in the middle of the last step.
  const Pose2 before = drive.truth[drive.truth.size() - 2];
  const Pose2 middle = compose(before, along_arc(0.02, 0.05));
  const PoseCorrection fix{.stamp_ns = drive.now() - 10 * kMs,
                           .received_ns = drive.now(),
                           .T_map_base = middle,
                           .sigma_x_m = 1e-6,
                           .sigma_y_m = 1e-6,
                           .sigma_yaw_rad = 1e-6};
  EXPECT_EQ(drive.filter.correct(fix, drive.now()), TimedVerdict::kUsed);
  EXPECT_LT(drive.error_m(), 1e-9);
}

TEST(PoseFilterTime, StaleOdometryGrowsUncertaintyAndLetsTheRobotBeFoundElsewhere) {
  SimulatedDrive drive;
  drive.trust();
  for (int i = 0; i < 100; ++i) drive.step(0, 0);
  std::int64_t now = drive.now();
  for (int i = 0; i < 1000; ++i) drive.filter.drift_until(now += 10 * kMs);
  const PoseEstimate estimate = drive.filter.estimate(now);
  EXPECT_EQ(estimate.speed_m_s, 0);
  // 0.3 m per root second, 10 s.
  EXPECT_NEAR(position_sigma_m(estimate.covariance), 0.3 * std::sqrt(10.0), 0.02);
  PoseCorrection fix = drive.fix(drive.now(), 1.5, 0, 0);
  fix.stamp_ns = now - 100 * kMs;
  EXPECT_EQ(drive.filter.correct(fix, now), TimedVerdict::kUsed);
}

TEST(PoseFilterTime, ARobotThatMovedWhenOdometryWentMissingMayBeFarther) {
  SimulatedDrive drive;
  drive.trust();
  for (int i = 0; i < 100; ++i) drive.step(0.02, 0);  // 1 m/s
  const double before = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
  drive.filter.drift_until(drive.now() + 1000 * kMs);
  const PoseEstimate estimate = drive.filter.estimate(drive.now() + 1000 * kMs);
  EXPECT_NEAR(position_sigma_m(estimate.covariance), std::sqrt(1 + 0.09 + before * before), 0.01);
}

// After a pause wheel positions show how far the robot went in it; fixes from the pause count too.
TEST(PoseFilterTime, TheMotionOfAPauseIsPutWhereItBelongs) {
  for (const bool with_fix : {false, true}) {
    SimulatedDrive drive;
    drive.trust();
    OdometryIncrement pause;
    pause.from_ns = drive.now();
    pause.motion.pose = along_arc(4 * 0.02 * 50, 4 * 0.01 * 50);
    pause.motion.covariance.xx = pause.motion.covariance.yy = 0.5;
    pause.motion.covariance.yaw_yaw = 0.01;
    for (int i = 1; i <= 200; ++i) {  // 4 s
      drive.truth.push_back(compose(drive.truth.back(), along_arc(0.02, 0.01)));
      drive.filter.drift_until(drive.now());
      if (with_fix && i % 50 == 0) {
        EXPECT_EQ(drive.correct(drive.now() - 140 * kMs), TimedVerdict::kUsed) << i;
      }
    }
    pause.to_ns = drive.now();
    drive.filter.predict(pause);
    EXPECT_LT(drive.error_m(), 1e-6);
    const double sigma = position_sigma_m(drive.filter.estimate(drive.now()).covariance);
    EXPECT_EQ(sigma < 0.5, with_fix) << sigma;
  }
}

TEST(PoseFilterTime, DoubtFromBeforeTheFirstSampleStays) {
  PoseFilter filter({});
  filter.start_at(0, {}, 0.1, 0.1);
  for (int i = 1; i <= 400; ++i) filter.drift_until(i * 10 * kMs);
  const double before = position_sigma_m(filter.estimate(4000 * kMs).covariance);
  EXPECT_GT(before, 0.5);
  OdometryIncrement first;
  first.from_ns = 4000 * kMs;
  first.to_ns = 4020 * kMs;
  first.motion.pose = {0.02, 0, 0};
  filter.predict(first);
  EXPECT_GE(position_sigma_m(filter.estimate(4020 * kMs).covariance), before);
}

TEST(PoseFilterTime, TheEstimateIsCarriedOnToNow) {
  SimulatedDrive drive;
  drive.trust();
  for (int i = 0; i < 200; ++i) drive.step(0.02, 0);
  const Pose2 at_sample = drive.filter.estimate(drive.now()).T_map_base;
  const auto ahead = [&](std::int64_t ms) {
    return between(at_sample, drive.filter.estimate(drive.now() + ms * kMs).T_map_base).x_m;
  };
  EXPECT_NEAR(ahead(10), 0.01, 1e-6);   // 1 m/s
  EXPECT_NEAR(ahead(5000), 0.1, 1e-5);  // no further than 0.1 s
  EXPECT_NEAR(drive.filter.estimate(drive.now()).speed_m_s, 1, 1e-6);
}

TEST(PoseFilterTime, SurvivesAClockThatWasSetBack) {
  SimulatedDrive drive;
  drive.trust();
  const Pose2 before = drive.filter.estimate(drive.now()).T_map_base;
  OdometryIncrement increment;
  increment.from_ns = drive.now();
  increment.to_ns = drive.now() - 3'600'000 * kMs;
  drive.filter.predict(increment);
  EXPECT_EQ(drive.filter.estimate(increment.to_ns).T_map_base, before);
  PoseCorrection fix{.stamp_ns = increment.to_ns,
                     .received_ns = increment.to_ns,
                     .T_map_base = before,
                     .sigma_x_m = 0.03,
                     .sigma_y_m = 0.03,
                     .sigma_yaw_rad = 0.01};
  EXPECT_EQ(drive.filter.correct(fix, increment.to_ns), TimedVerdict::kUsed);
}

TEST(PoseFilterTime, FastOdometrySharesEntriesOfTheHistory) {
  PoseFilterSettings settings;
  settings.history_s = 1;
  PoseFilter filter(settings);
  // 1 kHz: 51 entries of 20 ms still hold a second.
  Pose2 pose;
  std::vector<Pose2> truth{pose};
  const auto fix = [&](std::int64_t ms, double sigma) {
    return PoseCorrection{.stamp_ns = ms * kMs,
                          .received_ns = 0,
                          .T_map_base = truth[static_cast<std::size_t>(ms)],
                          .sigma_x_m = sigma,
                          .sigma_y_m = sigma,
                          .sigma_yaw_rad = sigma};
  };
  for (std::int64_t ms = 1; ms <= 3000; ++ms) {
    OdometryIncrement increment;
    increment.from_ns = (ms - 1) * kMs;
    increment.to_ns = ms * kMs;
    increment.motion.pose = along_arc(0.001, 0.0005);
    increment.motion.covariance.xx = 1e-7;
    pose = compose(pose, increment.motion.pose);
    truth.push_back(pose);
    filter.predict(increment);
    if (ms == 1007 || ms == 2013) filter.correct(fix(ms, 0.03), ms * kMs);
  }
  EXPECT_TRUE(filter.estimate(3000 * kMs).trusted);
  EXPECT_EQ(filter.correct(fix(2100, 0.03), 3000 * kMs), TimedVerdict::kUsed);
  EXPECT_EQ(filter.correct(fix(1500, 0.03), 3000 * kMs), TimedVerdict::kTooOld);
  EXPECT_NEAR(filter.estimate(3000 * kMs).T_map_base.x_m, pose.x_m, 1e-6);
}

}  // namespace
}  // namespace zonepack
