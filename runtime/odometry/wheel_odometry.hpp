// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/can_bus.hpp"
#include "runtime/odometry/can_signals.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack {

enum class OdometryModel : std::uint8_t {
  kDifferentialPositions,  // left and right wheel positions, counters that may wrap
  kWheelSpeeds,            // left and right wheel speeds
  kTwist,                  // forward speed and yaw rate
};

// How signals become motion. `left` and `right` mean, by model: positions in units of
// position_unit_m, speeds in units of position_unit_m per second; for kTwist forward speed (m/s)
// and yaw rate (rad/s).
struct WheelOdometrySettings {
  OdometryModel model = OdometryModel::kDifferentialPositions;
  CanSignal left, right;
  double metres_per_unit = 1;  // metres of ground per unit of a wheel signal (radius for radians)
  double track_m = 0.413;      // between the wheels' contact points
  double max_speed_m_s = 3;    // of the robot's middle; more is refused
  double max_yaw_rate_rad_s = 6;
  double max_acceleration_m_s2 = 15;  // of either wheel, between one sample and the next
  double gap_s = 0.5;      // a longer pause between samples is a gap: its motion is uncertain
  double timeout_s = 0.3;  // without a sample for so long, odometry is stale
  // Standard deviations of what the wheels do not tell. The variance of an increment grows with...
  double sigma_forward_per_sqrt_m = 0.02;    // ... distance: along
  double sigma_sideways_per_sqrt_m = 0.01;   // ... distance: across (slip)
  double sigma_yaw_per_sqrt_m = 0.01;        // ... distance: rad
  double sigma_yaw_per_sqrt_rad = 0.03;      // ... rotation: rad
  double sigma_forward_per_sqrt_rad = 0.01;  // ... rotation: the turning point wanders
  double sigma_gap_m_per_s = 0.5;            // ... time without samples, in a gap
  double sigma_gap_rad_per_s = 0.5;
};

// One step of dead reckoning: where base_link at to_ns stands, seen from base_link at from_ns, and
// how sure that is. Exact for motion along one arc.
struct OdometryIncrement {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  Pose2 motion;
  Covariance2 noise;     // of motion, in the frame at to_ns
  double speed_m_s = 0;  // mean over the step, forward
  double yaw_rate_rad_s = 0;
};

struct WheelOdometryCounters {
  std::uint64_t frames = 0;  // that carry one of the signals, refused ones included
  std::uint64_t rejected =
      0;  // refused: too short, remote request, not finite, implausible, not newer
  std::uint64_t jumps = 0;    // of these: implausible positions
  std::uint64_t gaps = 0;     // pauses longer than gap_s that an increment bridged
  std::uint64_t rebased = 0;  // positions taken anew without an increment (restart of the counter)
};

// Motion of a differential drive from the frames of a CAN bus.
//
// A sample is complete when both signals have come (one frame may carry both); its stamp is the
// later one's. Samples that are not newer than the last one are refused. A step faster or more
// abrupt than the limits is refused; when the next sample continues the refused one plausibly, the
// counter has been reset: odometry goes on from there, and the lost motion appears as uncertainty.
// A stamp that runs back by more than gap_s does the same (a clock that was set). Real-time: no
// allocation, bounded work per frame.   Threads: one.
class WheelOdometry {
 public:
  explicit WheelOdometry(const WheelOdometrySettings& settings) noexcept;

  // Takes a frame; returns an increment when it completed a sample. Increments follow each other
  // without gaps: from_ns is the to_ns before.
  std::optional<OdometryIncrement> take(const CanFrame& frame) noexcept;

  // No sample for timeout_s before now_ns, or none yet.
  bool stale(std::int64_t now_ns) const noexcept;

  // Stamp of the newest accepted sample; nullopt before the first.
  std::optional<std::int64_t> newest_ns() const noexcept;

  const WheelOdometryCounters& counters() const noexcept { return counters_; }
};

}  // namespace zonepack
