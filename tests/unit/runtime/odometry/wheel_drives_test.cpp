// SPDX-License-Identifier: Apache-2.0
// Whole drives with every wheel model, from frames to a pose, against the path they were made from.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>

#include "runtime/odometry/det_math.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;
constexpr double kStep_s = 0.01;

// Signals as doubles, one frame each: ids 1 to 4.
WheelOdometrySettings settings_of(OdometryModel model) {
  WheelOdometrySettings settings;
  settings.model = model;
  for (std::size_t i = 0; i < kMostWheels; ++i) {
    settings.signals[i].id = static_cast<std::uint32_t>(i + 1);
    settings.signals[i].bits = {0, 64, ByteOrder::kLittle};
    settings.signals[i].type = SignalType::kDouble;
  }
  return settings;
}

CanFrame frame(std::size_t signal, std::int64_t t_ns, double value) {
  CanFrame made;
  made.id = static_cast<std::uint32_t>(signal + 1);
  made.stamp_ns = t_ns;
  made.len = 8;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (std::size_t i = 0; i < 8; ++i) made.data[i] = static_cast<std::uint8_t>(bits >> (8 * i));
  return made;
}

// Body speeds at a time; from standing, so that nothing starts abruptly.
BodyMotion speed_at(double t_s, bool holonomic) {
  const double ramp = t_s < 1 ? t_s : 1;
  return {ramp * (0.8 + 0.2 * std::sin(t_s)), holonomic ? ramp * 0.4 * std::sin(0.7 * t_s) : 0,
          ramp * 0.5 * std::cos(0.3 * t_s)};
}

using Wheels = std::function<PerWheel(const BodyMotion&)>;

// Drives 60 s; `wheels` gives the signals' speeds of a motion (positions are their sums). Returns
// the error of the pose at the end in metres and radians together.
double drive(const WheelOdometrySettings& settings, bool holonomic, const Wheels& wheels) {
  WheelOdometry odometry(settings);
  const WheelModel model(settings.model, settings.geometry);
  Pose2 truth, pose;
  PerWheel positions{};
  for (int i = 0; i <= 6000; ++i) {
    const double t_s = i * kStep_s;
    // The mean of the interval, in fine steps.
    const BodyMotion now = speed_at(t_s, holonomic);
    if (i > 0) {
      for (int k = 0; k < 10; ++k) {
        const BodyMotion v = speed_at(t_s - kStep_s + (k + 0.5) * kStep_s / 10, holonomic);
        const double s = kStep_s / 10;
        truth = compose(truth, along_arc(v.forward_m * s, v.sideways_m * s, v.turn_rad * s));
        const PerWheel w = wheels(v);
        for (std::size_t n = 0; n < model.wheels(); ++n) positions[n] += w[n] * s;
      }
    }
    const PerWheel speeds = wheels(now);
    for (std::size_t n = 0; n < model.signals(); ++n) {
      const bool position = reads_positions(settings.model) && n < model.wheels();
      const auto step = odometry.take(frame(n, i * kStep_ns, position ? positions[n] : speeds[n]));
      if (step) pose = compose(pose, step->motion.pose);
    }
  }
  EXPECT_EQ(odometry.counters().rejected, 0u);
  EXPECT_GT(std::hypot(truth.x_m, truth.y_m), 1);
  return std::hypot(pose.x_m - truth.x_m, pose.y_m - truth.y_m) +
         std::abs(wrap_angle(pose.yaw_rad - truth.yaw_rad));
}

// After 45 m and many turns; the remaining error comes from reading speeds at 100 Hz.
constexpr double kClose = 2e-3;

TEST(WheelDrives, SkidSteering) {
  for (const auto model : {OdometryModel::kDifferentialPositions, OdometryModel::kWheelSpeeds}) {
    WheelOdometrySettings settings = settings_of(model);
    settings.geometry.track_m = 0.6;
    settings.geometry.slip_factor = 1.5;
    EXPECT_LT(
        drive(settings, false,
              [](const BodyMotion& v) {
                return PerWheel{v.forward_m - v.turn_rad * 0.45, v.forward_m + v.turn_rad * 0.45};
              }),
        kClose);
  }
}

TEST(WheelDrives, AckermannWithOffsetSteering) {
  for (const auto model : {OdometryModel::kAckermannPositions, OdometryModel::kAckermannSpeeds}) {
    WheelOdometrySettings settings = settings_of(model);
    settings.geometry.wheelbase_m = 0.7;
    settings.steering_offset_rad = 0.05;
    settings.metres_per_unit[1] = -1;  // right is positive on this robot
    EXPECT_LT(drive(settings, false,
                    [](const BodyMotion& v) {
                      const double angle =
                          v.forward_m > 0 ? std::atan(v.turn_rad * 0.7 / v.forward_m) : 0.0;
                      return PerWheel{v.forward_m, -(angle - 0.05)};
                    }),
              0.02);
  }
}

TEST(WheelDrives, Mecanum) {
  for (const auto model : {OdometryModel::kMecanumPositions, OdometryModel::kMecanumSpeeds}) {
    WheelOdometrySettings settings = settings_of(model);
    settings.geometry.track_m = 0.5;
    settings.geometry.wheelbase_m = 0.4;
    settings.metres_per_unit = {0.05, 0.05, 0.05, -0.05};  // radians, one wheel mounted reversed
    EXPECT_LT(drive(settings, true,
                    [](const BodyMotion& v) {
                      const double k = 0.45 * v.turn_rad;
                      const double x = v.forward_m, y = v.sideways_m;
                      return PerWheel{(x - y - k) / 0.05, (x + y + k) / 0.05, (x + y - k) / 0.05,
                                      (x - y + k) / -0.05};
                    }),
              kClose);
  }
}

TEST(WheelDrives, OmniWithThreeAndFourWheels) {
  for (const std::size_t count : {3u, 4u}) {
    for (const auto model : {OdometryModel::kOmniPositions, OdometryModel::kOmniSpeeds}) {
      WheelOdometrySettings settings = settings_of(model);
      settings.geometry.omni_radius_m = 0.25;
      settings.geometry.omni_bearing_rad = kPi / 3;
      settings.geometry.omni_wheels = count;
      EXPECT_LT(drive(settings, true,
                      [count](const BodyMotion& v) {
                        PerWheel wheels{};
                        for (std::size_t i = 0; i < count; ++i) {
                          const double b = kPi / 3 + 2 * kPi * static_cast<double>(i) /
                                                         static_cast<double>(count);
                          wheels[i] = -std::sin(b) * v.forward_m + std::cos(b) * v.sideways_m +
                                      0.25 * v.turn_rad;
                        }
                        return wheels;
                      }),
                kClose);
    }
  }
}

TEST(WheelDrives, SidewaysMotionIsSeenInSpeedAndUncertainty) {
  WheelOdometrySettings settings = settings_of(OdometryModel::kMecanumSpeeds);
  WheelOdometry odometry(settings);
  std::optional<OdometryIncrement> step;
  for (int i = 0; i < 2; ++i) {
    const double w[] = {-0.5, 0.5, 0.5, -0.5};
    for (std::size_t n = 0; n < 4; ++n) step = odometry.take(frame(n, i * kStep_ns, w[n]));
  }
  ASSERT_TRUE(step);
  EXPECT_EQ(step->sideways_m_s, 0.5);
  EXPECT_EQ(step->speed_m_s, 0);
  EXPECT_NEAR(step->motion.pose.y_m, 0.005, 1e-15);
  EXPECT_GT(step->motion.covariance.yy, step->motion.covariance.xx);
}

TEST(WheelDrives, ASteeringAngleThatNoAxleReachesIsRefused) {
  WheelOdometry odometry(settings_of(OdometryModel::kAckermannSpeeds));
  for (int i = 0; i < 3; ++i) {
    odometry.take(frame(0, i * kStep_ns, 0.1));
    // The first sample begins, the second is refused, the third continues from the first.
    EXPECT_EQ(odometry.take(frame(1, i * kStep_ns, i == 1 ? 3.1 : 0)).has_value(), i == 2) << i;
  }
  EXPECT_EQ(odometry.counters().jumps, 1u);
}

}  // namespace
}  // namespace zonepack
