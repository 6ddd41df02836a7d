// SPDX-License-Identifier: Apache-2.0
// Scenario 1 from its CAN log to a pose, with the settings of config/agilex.yaml.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "platform/can/can_log.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/odometry/pose_filter.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kCycle_ns = 10'000'000;
const std::string kFolder = ZONEPACK_TEST_DATA "/scenario1_loop/";

struct DriveErrors {
  std::vector<double> error_m;  // per cycle with a valid pose, sorted
  double nees = 0;              // mean of the squared error over its covariance, once trusted
  bool trusted = false;
  std::uint64_t wrong_fixes = 0, wrong_fixes_used = 0, good_fixes_refused = 0;
  WheelOdometryCounters odometry;
  PoseFilterCounters filter;
  double quantile_m(double q) const {
    return error_m[static_cast<std::size_t>(q * static_cast<double>(error_m.size() - 1))];
  }
};

// alter(i, fix): changes the i-th fix; false leaves it out.
using Alter = std::function<bool(std::size_t, PoseCorrection&)>;

DriveErrors drive(const Alter& alter, bool start_at_truth = false,
                  OdometryModel model = OdometryModel::kDifferentialPositions) {
  Settings settings = load_settings(ZONEPACK_SOURCE_DIR "/config/agilex.yaml").settings;
  if (model == OdometryModel::kTwist) {
    settings.odometry.wheels.model = model;
    settings.odometry.wheels.signals[0] = settings.can.signals.at("linear_velocity");
    settings.odometry.wheels.signals[1] = settings.can.signals.at("turn_rate");
  }
  const auto fixes = read_corrections(kFolder + "corrections.txt");
  const auto truth = read_truth(kFolder + "base_groundtruth.txt");
  CanLogReader log(kFolder + "can0.log", settings.can.interface);
  EXPECT_TRUE(fixes && truth && log.open().ok());
  SimCanBus bus(&log);
  WheelOdometry odometry(settings.odometry.wheels);
  PoseFilter filter(settings.pose);
  DriveErrors errors;
  std::int64_t now = *bus.next_arrival_ns();
  if (start_at_truth) filter.start_at(now, truth->samples().front().T_map_base, 0.05, 0.02);
  std::array<CanFrame, 64> batch;
  std::size_t next_fix = 0;
  std::size_t nees_count = 0;
  for (; bus.next_arrival_ns(); now += kCycle_ns) {
    bus.advance_to(now);
    const std::size_t received = bus.receive(batch);
    for (std::size_t i = 0; i < received; ++i) {
      if (const auto increment = odometry.take(batch[i])) filter.predict(*increment);
    }
    if (odometry.stale(now)) filter.drift_until(now);
    for (; next_fix < fixes->size() && (*fixes)[next_fix].received_ns <= now; ++next_fix) {
      PoseCorrection fix = (*fixes)[next_fix];
      if (!alter(next_fix, fix)) continue;
      const Pose2 real = *truth->at(fix.stamp_ns);
      const bool wrong =
          std::hypot(fix.T_map_base.x_m - real.x_m, fix.T_map_base.y_m - real.y_m) > 0.5;
      const CorrectionVerdict verdict = filter.correct(fix, now);
      errors.wrong_fixes += wrong ? 1 : 0;
      errors.wrong_fixes_used += wrong && verdict == CorrectionVerdict::kUsed ? 1 : 0;
      errors.good_fixes_refused += !wrong && verdict == CorrectionVerdict::kOutlier ? 1 : 0;
    }
    const PoseEstimate estimate = filter.estimate(now);
    const auto real = truth->at(now);
    if (!estimate.valid || !real) continue;
    errors.trusted = estimate.trusted;
    errors.error_m.push_back(
        std::hypot(estimate.T_map_base.x_m - real->x_m, estimate.T_map_base.y_m - real->y_m));
    if (estimate.trusted) {
      errors.nees += mahalanobis2({estimate.T_map_base, estimate.covariance}, {*real, {}});
      ++nees_count;
    }
  }
  if (nees_count > 0) errors.nees /= static_cast<double>(nees_count);
  std::sort(errors.error_m.begin(), errors.error_m.end());
  errors.odometry = odometry.counters();
  errors.filter = filter.counters();
  return errors;
}

bool as_they_are(std::size_t, PoseCorrection&) { return true; }

TEST(MissionPose, StaysWithinCentimetresOfTheTruthAndRefusesEveryWrongFix) {
  const DriveErrors errors = drive(as_they_are);
  EXPECT_TRUE(errors.trusted);
  EXPECT_LT(errors.quantile_m(0.5), 0.025);
  EXPECT_LT(errors.quantile_m(0.95), 0.05);
  EXPECT_LT(errors.quantile_m(1), 0.07);
  EXPECT_EQ(errors.odometry.rejected, 0u);
  EXPECT_EQ(errors.odometry.frames, 5523u);
  EXPECT_GT(errors.wrong_fixes, 0u);
  EXPECT_EQ(errors.wrong_fixes_used, 0u);
  EXPECT_EQ(errors.good_fixes_refused, 0u);
  // Honest: 3 is right, half or twice would be lying.
  EXPECT_GT(errors.nees, 1.5);
  EXPECT_LT(errors.nees, 5);
}

TEST(MissionPose, TwistMessagesDoAlmostAsWell) {
  const DriveErrors errors = drive(as_they_are, false, OdometryModel::kTwist);
  EXPECT_LT(errors.quantile_m(0.95), 0.06);
  EXPECT_EQ(errors.good_fixes_refused, 0u);
}

TEST(MissionPose, WithoutFixesDeadReckoningDriftsAndIsNotTrusted) {
  const DriveErrors errors = drive([](std::size_t, PoseCorrection&) { return false; }, true);
  EXPECT_FALSE(errors.trusted);
  EXPECT_GT(errors.quantile_m(1), 0.5);
  EXPECT_LT(errors.quantile_m(1), 2.5);
}

TEST(MissionPose, EverySecondFixWrongCostsAccuracyOnly) {
  const DriveErrors errors = drive([](std::size_t i, PoseCorrection& fix) {
    if (i % 2 == 1) fix.T_map_base.x_m += 2 + static_cast<double>(i % 5);
    return true;
  });
  EXPECT_TRUE(errors.trusted);
  EXPECT_EQ(errors.wrong_fixes_used, 0u);
  EXPECT_EQ(errors.good_fixes_refused, 0u);
  EXPECT_LT(errors.quantile_m(0.95), 0.08);
}

TEST(MissionPose, FindsBackWhenGoodFixesReturnAfterWrongOnesThatAgreed) {
  // For 20 s all fixes are 4 m off to the east; then they are right again.
  const DriveErrors errors = drive([](std::size_t i, PoseCorrection& fix) {
    if (i >= 20 && i < 40) fix.T_map_base.x_m += 4;
    return true;
  });
  EXPECT_EQ(errors.filter.reinitialised, 2u);
  EXPECT_LT(errors.quantile_m(0.5), 0.03);
}

}  // namespace
}  // namespace zonepack
