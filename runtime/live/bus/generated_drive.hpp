// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {

// A stretch of a drive at even speed, reached from the one before at kLegAcceleration.
struct DriveLeg {
  double for_s = 1;
  double speed_m_s = 0;
  double yaw_rate_rad_s = 0;
};

inline constexpr double kLegAcceleration_m_s2 = 2;
inline constexpr double kLegAcceleration_rad_s2 = 5;

struct DriveSettings {
  double period_s = 0.02;  // between samples
  std::vector<DriveLeg> legs;
  std::uint32_t loops = 1;  // times that the legs are driven
};

// Writes a value into the bits of a signal; what does not fit is cut, as a counter wraps.
void write_signal(const CanSignal& signal, double value, CanFrame& frame) noexcept;

// The frames that the robot of some settings would send on a drive: all signals of its wheels at
// every period, and the heartbeats of watched CANopen nodes. The first leg begins at 0.
class GeneratedDrive final : public CanFrameSource {
 public:
  // Fails when frames of this model cannot be generated.
  static Outcome<void> check(const WheelOdometrySettings& odometry);

  GeneratedDrive(DriveSettings drive, const WheelOdometrySettings& odometry)
      : drive_(std::move(drive)), odometry_(odometry) {}

  std::optional<CanFrame> next() noexcept override;

 private:
  bool make_sample();
  void move(const DriveLeg& leg) noexcept;

  DriveSettings drive_;
  WheelOdometrySettings odometry_;
  std::deque<CanFrame> made_;
  std::size_t leg_ = 0;  // over all loops
  double in_leg_s_ = 0;
  std::int64_t sample_ = 0;
  double speed_m_s_ = 0, yaw_rate_rad_s_ = 0;
  double left_m_ = 0, right_m_ = 0;
};

// Frames of one id, evenly spaced and without end: traffic of other nodes.
class PeriodicFrames final : public CanFrameSource {
 public:
  PeriodicFrames(const CanFrame& first, std::int64_t period_ns) noexcept
      : frame_(first), period_ns_(period_ns) {}
  std::optional<CanFrame> next() noexcept override {
    const CanFrame given = frame_;
    frame_.stamp_ns += period_ns_;
    return given;
  }

 private:
  CanFrame frame_;
  std::int64_t period_ns_;
};

}  // namespace zonepack
