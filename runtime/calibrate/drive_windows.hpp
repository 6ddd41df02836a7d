// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "runtime/calibrate/wheel_calibration.hpp"
#include "runtime/odometry/can_signals.hpp"
#include "runtime/run/inputs/run_files.hpp"

namespace zonepack {

// What the robot did, from another source than its wheels.
struct TrueMotion {
  double forward_m = 0;
  double turn_rad = 0;        // counter-clockwise
  bool forward_known = true;  // false: from a gyroscope, which knows turns only
};

// The motion between two stamps; nothing where the source does not cover both.
using TrueMotionOf = std::function<std::optional<TrueMotion>(std::int64_t from_ns,  //
                                                             std::int64_t to_ns)>;

// From poses: a true path, or the fixes of a localizer. `track` must outlive the function.
TrueMotionOf motion_on(const TruthTrack& track);

// Of fixes, in any order, those that a track can be made of; nothing from fewer than two.
std::optional<TruthTrack> track_of(const std::vector<PoseCorrection>& corrections);

// A piece of a drive as the wheels report it, and as it was.
struct DriveWindow {
  double seconds = 0;
  double left_m = 0, right_m = 0;
  TrueMotion truth;
};

// Cuts the steps of a drive into windows of kCalibrationWindow_s and compares each with the truth.
//
// Memory: the newest kMost windows.
class DriveWindows {
 public:
  static constexpr std::size_t kMost = 1000;

  explicit DriveWindows(TrueMotionOf truth = {}) : truth_(std::move(truth)) {}

  void add(const WheelStep& step);
  const std::deque<DriveWindow>& windows() const noexcept { return windows_; }

 private:
  TrueMotionOf truth_;
  DriveWindow open_;
  std::int64_t from_ns_ = 0;
  bool begun_ = false;
  std::deque<DriveWindow> windows_;
};

// The motion by two signals of the robot, a forward speed and a yaw rate, such as those of its
// drive controller or a gyroscope. Without a forward speed only turns are known.
//
// Memory: the newest kMost samples.
class TwistTrack {
 public:
  static constexpr std::size_t kMost = 4096;

  void add_forward(double m_s);
  void add_yaw_rate(std::int64_t stamp_ns, double rad_s);
  bool empty() const noexcept { return samples_.empty(); }

  std::optional<TrueMotion> between(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  struct Sample {
    std::int64_t stamp_ns = 0;
    TrueMotion total;
  };
  std::optional<TrueMotion> at(std::int64_t stamp_ns) const;

  std::deque<Sample> samples_;
  double forward_m_s_ = 0, yaw_rate_rad_s_ = 0;
  bool forward_known_ = false;
};

}  // namespace zonepack
