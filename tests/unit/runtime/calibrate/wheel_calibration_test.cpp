// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/wheel_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/odometry/se2.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStep_ns = 20'000'000;

// A drive at 50 Hz with turns both ways. The wheels report what they did divided by `values`, and
// slip at random: standard deviation `slip` per root of a metre.
struct Made {
  std::vector<WheelStep> steps;
  std::vector<TruthTrack::Sample> truth;
};
Made make_drive(const CalibrationValues& values, double slip, int steps, double turn_share = 1) {
  Made made;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Pose2 pose;
  made.truth.push_back({0, pose});
  for (int i = 0; i < steps; ++i) {
    const double t = i * 0.02;
    const double forward = 0.01 + 0.004 * std::sin(t);
    const double turn = turn_share * 0.012 * std::sin(0.4 * t);
    pose = compose(pose, along_arc(forward, turn));
    made.truth.push_back({(i + 1) * kStep_ns, pose});
    const double noise = slip * std::sqrt(forward);
    made.steps.push_back(
        {.from_ns = i * kStep_ns,
         .to_ns = (i + 1) * kStep_ns,
         .left_m = (forward - turn * values.track_m / 2) / values.left + noise * normal(random),
         .right_m = (forward + turn * values.track_m / 2) / values.right + noise * normal(random),
         .known = true});
  }
  return made;
}

Outcome<WheelCalibration> outcome_of(const Made& made) {
  WheelOdometrySettings settings;
  settings.geometry.track_m = 0.4;
  return calibrate(made.steps, TruthTrack(made.truth), settings);
}

WheelCalibration run(const Made& made) {
  const auto found = outcome_of(made);
  EXPECT_TRUE(found.ok()) << found.error().message;
  return found ? *found : WheelCalibration{};
}

TEST(WheelCalibration, FindsScaleAndTrackOfWheelsThatDoNotSlip) {
  const WheelCalibration c =
      run(make_drive({.left = 1.02, .right = 1.02, .track_m = 0.43}, 0, 5000));
  EXPECT_FALSE(c.sides_differ);
  EXPECT_NEAR(c.fitted.left, 1.02, 1e-6);
  EXPECT_NEAR(c.fitted.right, 1.02, 1e-6);
  EXPECT_NEAR(c.fitted.track_m, 0.43, 1e-6);
  EXPECT_GT(c.before.end_m, 0.5);
  EXPECT_LT(c.after.end_m, 1e-4);
  EXPECT_NEAR(c.seconds, 100, 2.1);
}

TEST(WheelCalibration, DistinguishesTheSidesWhenTheyDiffer) {
  const WheelCalibration c =
      run(make_drive({.left = 1.01, .right = 0.99, .track_m = 0.41}, 0.001, 5000));
  EXPECT_TRUE(c.sides_differ);
  EXPECT_NEAR(c.fitted.left, 1.01, 1e-3);
  EXPECT_NEAR(c.fitted.right, 0.99, 1e-3);
  EXPECT_NEAR(c.fitted.track_m, 0.41, 3e-3);
  EXPECT_LT(c.after.rmse_m * 5, c.before.rmse_m);
}

TEST(WheelCalibration, TakesTheSidesToBeAlikeWhenTheirDifferenceMayBeSlip) {
  const WheelCalibration c =
      run(make_drive({.left = 1.005, .right = 1.005, .track_m = 0.404}, 0.003, 5000));
  EXPECT_FALSE(c.sides_differ);
  EXPECT_EQ(c.fitted.left, c.fitted.right);
  // The truth is within three of the reported standard deviations.
  EXPECT_NEAR(c.fitted.left, 1.005, 3 * c.scale_sigma);
  EXPECT_NEAR(c.fitted.track_m, 0.404, 3 * c.track_sigma_m);
  EXPECT_GT(c.scale_sigma, 1e-5);
  EXPECT_LT(c.scale_sigma, 2e-3);
}

TEST(WheelCalibration, RefusesADriveThatIsNotInformative) {
  const auto short_drive =
      outcome_of(make_drive({.left = 1, .right = 1, .track_m = 0.4}, 0, 250));  // 5 s at 0.5 m/s
  ASSERT_FALSE(short_drive);
  EXPECT_THAT(short_drive.error().message,
              HasSubstr("needed: at least 10.0 m and 6.3 rad (a full turn), better 100 m"));
  const auto straight_drive =
      outcome_of(make_drive({.left = 1, .right = 1, .track_m = 0.4}, 0, 5000, 0.01));
  ASSERT_FALSE(straight_drive);
  EXPECT_THAT(straight_drive.error().message, HasSubstr("m and 0."));
}

TEST(WheelCalibration, DoesNotLookAcrossGapsNorBeyondTheTruth) {
  Made made = make_drive({.left = 1.02, .right = 1.02, .track_m = 0.43}, 0, 6000);
  for (std::size_t i = 100; i < made.steps.size(); i += 500) {
    made.steps[i].left_m += 3;
    made.steps[i].known = false;
  }
  made.truth.resize(5000);
  const WheelCalibration c = run(made);
  EXPECT_NEAR(c.fitted.left, 1.02, 1e-6);
  EXPECT_NEAR(c.fitted.track_m, 0.43, 1e-6);
}

}  // namespace
}  // namespace zonepack
