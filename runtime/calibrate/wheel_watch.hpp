// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/calibrate/drive_windows.hpp"
#include "runtime/calibrate/signal_trace.hpp"
#include "runtime/calibrate/wheel_calibration.hpp"
#include "runtime/calibrate/wheel_hints.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// What the wheels are compared with.
struct Reference {
  TrueMotionOf motion;
  std::string name;  // "the true path"
};

// Follows the wheels through the frames of a bus as zoned would, and once more without limits of
// speed, and gathers what wheel_hints() needs. Not for the control thread.
//
// Without a reference, signals that the settings name for a twist serve as one where the model
// reads others: odometry.forward and odometry.yaw_rate.
// Memory: bounded, however long the drive is.
class WheelWatch {
 public:
  // `settings` must outlive this object.
  explicit WheelWatch(const Settings& settings, Reference reference = {});
  WheelWatch(const WheelWatch&) = delete;
  WheelWatch& operator=(const WheelWatch&) = delete;

  // The step that the frame completed, as zoned accepts it.
  std::optional<WheelStep> take(const CanFrame& frame);

  WheelEvidence evidence() const;
  // Also of a drive whose windows nothing could be compared in.
  const WheelOdometry& odometry() const noexcept { return odometry_; }
  const std::vector<SignalTrace>& traces() const noexcept { return traces_; }
  // The newest accepted increment.
  const std::optional<OdometryIncrement>& increment() const noexcept { return increment_; }

 private:
  void follow_without_limits(const CanFrame& frame);
  WheelStep step_of(const OdometryIncrement& increment, bool known) const;

  const Settings& settings_;
  Reference reference_;
  double half_track_m_;
  WheelOdometry odometry_, unlimited_;
  std::vector<SignalTrace> traces_;
  std::optional<CanSignal> forward_, yaw_rate_;  // of the twist that serves as a reference
  double forward_factor_ = 1, yaw_factor_ = 1;   // to m/s and rad/s
  TwistTrack twist_;
  DriveWindows windows_;
  std::optional<OdometryIncrement> increment_;
  std::uint64_t accepted_ = 0;
  std::vector<double> fast_m_s_;  // a ring
  std::size_t fast_seen_ = 0;
};

}  // namespace zonepack
