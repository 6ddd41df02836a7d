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

// How signals become motion. `left` and `right` mean, by model: wheel positions in units (metres,
// turns, radians ...), wheel speeds in units per second, or, for kTwist, forward speed (m/s) and
// yaw rate (rad/s).
struct WheelOdometrySettings {
  OdometryModel model = OdometryModel::kDifferentialPositions;
  CanSignal left, right;
  double metres_per_unit = 1;         // ground covered per unit of a wheel signal; not for kTwist
  double track_m = 0.413;             // between the wheels' contact points; not for kTwist
  double max_speed_m_s = 3;           // of the robot's middle; more is refused
  double max_yaw_rate_rad_s = 6;      // more is refused
  double max_acceleration_m_s2 = 10;  // of either wheel from sample to sample, over the resolution
  double gap_s = 0.5;                 // a longer pause between samples is a gap
  double timeout_s = 0.3;             // without a sample for so long, odometry is stale
  // Standard deviations of what the wheels do not tell: slip, wrong radius and track, uneven floor.
  double sigma_forward_per_sqrt_m = 0.015;
  double sigma_sideways_per_sqrt_m = 0.005;
  double sigma_yaw_per_sqrt_m = 0.005;
  double sigma_forward_per_sqrt_rad = 0.005;
  double sigma_yaw_per_sqrt_rad = 0.02;
  // A gap: the path between two positions is not known (share of its length); speeds tell nothing.
  double sigma_gap_per_m = 0.25;
  double sigma_gap_m_per_s = 0.5;
  double sigma_gap_rad_per_s = 0.5;
};

// One step of dead reckoning: where base_link at to_ns stands, seen from base_link at from_ns, and
// how sure that is (covariance in the frame at from_ns). Exact for motion along one arc.
struct OdometryIncrement {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;  // not after from_ns only when the clock ran back
  UncertainPose motion;
  double speed_m_s = 0;  // forward, over the step
  double yaw_rate_rad_s = 0;
};

struct WheelOdometryCounters {
  std::uint64_t frames = 0;    // that carry one of the signals, refused ones included
  std::uint64_t rejected = 0;  // refused: short, remote request, not finite, implausible, not newer
  std::uint64_t jumps = 0;     // of these: faster or more abrupt than the limits
  std::uint64_t gaps = 0;      // pauses longer than gap_s that an increment bridged
  std::uint64_t rebased =
      0;  // new starting points after a jump that stayed or a clock that ran back
};

// Motion of a differential drive from the frames of a CAN bus.
//
// A sample is complete when both signals have come (one frame may carry both); its stamp is the
// later one's. Samples that are not newer than the last are refused, and so is a step faster or
// more abrupt than the limits. When the next sample does not continue the last good one, but does
// continue the refused one, the counter was reset or the clock was set back: odometry goes on from
// there, and the motion that was lost appears as uncertainty. Counters may start anywhere and wrap
// at any length. Real-time: no allocation, bounded work per frame.   Threads: one.
class WheelOdometry {
 public:
  // The signals must be valid.
  explicit WheelOdometry(const WheelOdometrySettings& settings) noexcept;

  // Takes a frame; returns an increment when it completed a sample. from_ns is the to_ns before.
  std::optional<OdometryIncrement> take(const CanFrame& frame) noexcept;

  // No sample for timeout_s before now_ns, or none yet.
  bool stale(std::int64_t now_ns) const noexcept;

  // Stamp of the newest accepted sample; nullopt before the first.
  std::optional<std::int64_t> newest_ns() const noexcept;

  const WheelOdometryCounters& counters() const noexcept { return counters_; }

 private:
  struct Side {
    std::int64_t stamp_ns = 0;
    SignalReading reading;
    bool fresh = false;
  };
  struct Sample {
    std::int64_t stamp_ns = 0;
    SignalReading left, right;
  };
  // Motion from one sample to the next; speeds of (left, right), or (forward, yaw rate) of a twist.
  struct Step {
    double seconds = 0;
    double distance_m = 0;
    double turn_rad = 0;
    double speed_left = 0, speed_right = 0;
  };

  std::optional<Sample> complete_sample(const CanFrame& frame) noexcept;
  Step step_between(const Sample& from, const Sample& to) const noexcept;
  double units_moved(const CanSignal& signal, const SignalReading& from,
                     const SignalReading& to) const noexcept;
  bool plausible(const Step& step) const noexcept;
  bool too_abrupt(const Step& before, const Step& step) const noexcept;
  OdometryIncrement accept(const Sample& to, const Step& step) noexcept;
  OdometryIncrement rebase(const Sample& to, const Step& step) noexcept;
  Covariance2 noise_of(const Step& step) const noexcept;

  WheelOdometrySettings settings_;
  double resolution_left_, resolution_right_;
  Side left_, right_;
  std::optional<Sample> last_;     // accepted
  std::optional<Step> last_step_;  // that led to last_; none after a start or a gap
  std::optional<Sample> suspect_;  // the newest refused one
  WheelOdometryCounters counters_;
};

}  // namespace zonepack
