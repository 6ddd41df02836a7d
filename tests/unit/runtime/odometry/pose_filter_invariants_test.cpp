// SPDX-License-Identifier: Apache-2.0
// What holds for any input: honest, bounded, finite, the same bits everywhere.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "runtime/odometry/pose_filter.hpp"
#include "tests/support/allocation_count/allocation_count.hpp"
#include "tests/unit/runtime/odometry/simulated_drive.hpp"

namespace zonepack {
namespace {

// Noisy odometry and fixes as the model says: the squared error over its covariance has mean 3.
TEST(PoseFilterInvariants, ItsUncertaintyIsHonest) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  double sum = 0;
  int count = 0;
  for (int run = 0; run < 40; ++run) {
    PoseFilter filter({});
    Pose2 truth;
    for (int i = 1; i <= 1500; ++i) {
      OdometryIncrement increment;
      increment.from_ns = (i - 1) * 20 * kMs;
      increment.to_ns = i * 20 * kMs;
      const double turn = 0.02 * std::sin(i * 0.01);
      Covariance2& noise = increment.motion.covariance;
      noise.xx = 1e-4 * 0.02, noise.yy = 2.5e-5 * 0.02, noise.yaw_yaw = 1e-4 * 0.02;
      const Pose2 motion = along_arc(0.02, turn);
      increment.motion.pose = {motion.x_m + std::sqrt(noise.xx) * normal(random),
                               motion.y_m + std::sqrt(noise.yy) * normal(random),
                               motion.yaw_rad + std::sqrt(noise.yaw_yaw) * normal(random)};
      truth = compose(truth, motion);
      filter.predict(increment);
      if (i % 50 == 0) {
        filter.correct({i * 20 * kMs,
                        0,
                        {truth.x_m + 0.03 * normal(random), truth.y_m + 0.03 * normal(random),
                         truth.yaw_rad + 0.01 * normal(random)},
                        0.03,
                        0.03,
                        0.01},
                       i * 20 * kMs);
      }
      if (i > 300 && i % 25 == 0) {
        const PoseEstimate e = filter.estimate(i * 20 * kMs);
        sum += mahalanobis2({e.T_map_base, e.covariance}, {truth, {}});
        ++count;
      }
    }
  }
  EXPECT_NEAR(sum / count, 3, 0.35);
}

TEST(PoseFilterInvariants, TakesNoMemoryAfterConstruction) {
  SimulatedDrive drive;
  drive.truth.reserve(4000);
  const testing_support::AllocationCount allocations;
  drive.filter.start_at(0, {});
  for (int i = 0; i < 60; ++i) {
    drive.steps(50);
    drive.correct_now(i % 7 == 0 ? 3 : 0, 0, 0);
  }
  drive.filter.drift_until(drive.now() + 1000 * kMs);
  EXPECT_EQ(allocations.count(), 0u);
}

// The whole chain decides the same on every CPU and compiler: bits of the estimates of a noisy
// drive.
TEST(PoseFilterInvariants, GivesTheSameBitsEverywhere) {
  std::mt19937_64 random(31);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  PoseFilterSettings settings;
  settings.gate_chi2 = 16.27;
  settings.speed_filter_s = 0.1;
  SimulatedDrive drive(settings);
  std::uint64_t hash = 0xCBF29CE484222325u;
  const auto mix = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3u;
  };
  for (int i = 1; i <= 5000; ++i) {
    const double distance = 0.01 + 0.01 * unit();
    const double turn = 0.03 * unit();
    drive.step(distance, turn);
    if (i % 50 == 0) {
      const double off = i % 350 == 0 ? 3 : 0.05;
      const double dx = off * unit();
      const double dy = off * unit();
      const double dyaw = 0.02 * unit();
      drive.correct(drive.now() - 140 * kMs, dx, dy, dyaw);
    }
    const PoseEstimate e = drive.filter.estimate(drive.now() + 7 * kMs);
    mix(e.T_map_base.x_m), mix(e.T_map_base.y_m), mix(e.T_map_base.yaw_rad);
    mix(e.covariance.xx), mix(e.covariance.x_yaw), mix(e.covariance.yaw_yaw);
  }
  EXPECT_GT(drive.filter.counters().outliers, 10u);
  EXPECT_EQ(hash, 0x713c4511a2a05b22u);
}

// Any input at all: the estimate stays finite and the covariance positive.
TEST(PoseFilterInvariants, StaysFiniteUnderRandomInput) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(-1, 1);
  PoseFilterSettings settings;
  settings.history_s = 0.5;
  PoseFilter filter(settings);
  std::int64_t now = 0;
  for (int i = 0; i < 50'000; ++i) {
    now += static_cast<std::int64_t>(random() % 40) * kMs;
    switch (random() % 8) {
      case 0: {
        PoseCorrection fix{.stamp_ns = now - static_cast<std::int64_t>(random() % 800) * kMs,
                           .received_ns = now,
                           .T_map_base = {unit(random) * 3, unit(random) * 3, unit(random) * 7},
                           .sigma_x_m = 0.1,
                           .sigma_y_m = 0.1,
                           .sigma_yaw_rad = 0.1};
        if (random() % 20 == 0) fix.sigma_x_m = std::pow(10.0, unit(random) * 12);
        filter.correct(fix, now);
        break;
      }
      case 1:
        filter.drift_until(now);
        break;
      case 2:
        if (random() % 50 == 0) filter.start_at(now, {unit(random), unit(random), unit(random)});
        break;
      default: {
        OdometryIncrement step;
        step.from_ns = now - 20 * kMs;
        step.to_ns = now + static_cast<std::int64_t>(random() % 60) * kMs - 30 * kMs;
        step.motion.pose = along_arc(unit(random) * 0.1, unit(random) * 0.5);
        step.motion.covariance.xx = step.motion.covariance.yy = 1e-6;
        filter.predict(step);
      }
    }
    const PoseEstimate e = filter.estimate(now);
    if (!e.valid) continue;
    ASSERT_TRUE(is_finite(e.T_map_base)) << i;
    ASSERT_GE(e.covariance.xx, 0) << i;
    ASSERT_GE(e.covariance.yaw_yaw, 0) << i;
    ASSERT_LE(filter.hypotheses().size(), kMaxHypotheses);
  }
}

}  // namespace
}  // namespace zonepack
