// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "platform/can/can_bus.hpp"
#include "runtime/odometry/can_signals.hpp"
#include "runtime/odometry/canopen_watch.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/odometry/wheel_model.hpp"

namespace zonepack {

// How signals become motion. By model the signals are, in this order: wheels (wheel_model.hpp), as
// positions in units (metres, turns, ticks ...) or as speeds in units per second; the driven axle
// and the steering angle (rad); forward speed (m/s) and yaw rate (rad/s).
struct WheelOdometrySettings {
  OdometryModel model = OdometryModel::kDifferentialPositions;
  WheelGeometry geometry;
  std::array<CanSignal, kMostWheels> signals{};
  PerWheel metres_per_unit = {1, 1, 1, 1};  // ground covered per unit of a wheel; otherwise a sign
  double steering_offset_rad = 0;           // added to the steering angle
  CanOpenWatchSettings canopen;
  double max_speed_m_s = 3;           // of the robot's middle; more is refused
  double max_yaw_rate_rad_s = 6;      // more is refused
  double max_acceleration_m_s2 = 10;  // of either wheel from sample to sample, over the resolution
  double gap_s = 0.5;                 // a longer pause between samples is a gap
  double timeout_s = 0.3;             // without a sample for this long, odometry is stale
  // Standard deviations of what the wheels do not show: slip, wrong radius and track, uneven floor.
  double sigma_forward_per_sqrt_m = 0.015;
  double sigma_sideways_per_sqrt_m = 0.005;
  double sigma_yaw_per_sqrt_m = 0.005;
  double sigma_forward_per_sqrt_rad = 0.005;
  double sigma_yaw_per_sqrt_rad = 0.02;
  // A gap: the path between two positions is not known (share of its length); speeds say nothing
  // about it.
  double sigma_gap_per_m = 0.25;
  double sigma_gap_m_per_s = 0.5;
  double sigma_gap_rad_per_s = 0.5;
};

// The signals that the model reads, for filters on the bus; CANopen's frames come on top of them.
std::span<const CanSignal> signals_of(const WheelOdometrySettings& settings) noexcept;

// One step of dead reckoning: where base_link at to_ns stands, seen from base_link at from_ns, and
// how sure that is (covariance in the frame at from_ns). Exact for motion along one arc.
struct OdometryIncrement {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;  // not after from_ns only when the clock ran back
  UncertainPose motion;
  double speed_m_s = 0;     // forward, over the step
  double sideways_m_s = 0;  // to the left
  double yaw_rate_rad_s = 0;
};

struct WheelOdometryCounters {
  std::uint64_t frames = 0;    // that carry one of the signals, refused ones included
  std::uint64_t rejected = 0;  // refused: short, remote request, not finite, implausible, not newer
  std::uint64_t jumps = 0;     // of these: faster or more abrupt than the limits
  std::uint64_t unreadable = 0;  // of the refused: short, remote request, not finite
  std::uint64_t too_fast = 0;    // of the jumps: above max_speed or max_yaw_rate
  std::uint64_t not_newer = 0;   // of the refused: stamp not after the last sample's
  std::uint64_t gaps = 0;        // pauses longer than gap_s that an increment bridged
  std::uint64_t rebased = 0;     // new starting points: a jump that stayed, a clock that ran back
  std::uint64_t unwatched = 0;   // of the refused: while a watched CANopen node or SYNC was missing
  CanOpenCounters canopen;
};

// Motion of a wheeled robot from the frames of a CAN bus.
//
// A sample is complete when all signals have come (one frame may carry several); its stamp is the
// latest one's. Samples that are not newer than the last are refused, and so is a step faster or
// more abrupt than the limits. When the next sample does not continue the last good one, but does
// continue the refused one, the counter was reset or the clock was set back: odometry continues
// from there, and the lost motion appears as uncertainty. Counters may start anywhere and wrap at
// any length. While a watched CANopen node or SYNC is missing, frames are refused, so that odometry
// goes stale by its timeout; a node that restarts counts as a counter reset.
// Real-time: no allocation, bounded work per frame.
// Threads: one.
class WheelOdometry {
 public:
  // The signals must be valid.
  explicit WheelOdometry(const WheelOdometrySettings& settings) noexcept;

  // Takes a frame; returns an increment when it completed a sample. from_ns is the previous to_ns.
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
    std::array<SignalReading, kMostWheels> signals{};
  };
  // Motion from one sample to the next.
  struct Step {
    double seconds = 0;
    BodyMotion motion;
    PerWheel speeds{};  // of each signal: m/s of wheels; of a twist forward and yaw rate
    double steering_rad = 0;
  };

  bool note_readings(const CanFrame& frame) noexcept;
  std::optional<Sample> complete_sample(const CanFrame& frame) noexcept;
  std::optional<OdometryIncrement> start_anew(const Sample& sample) noexcept;
  Step step_between(const Sample& from, const Sample& to) const noexcept;
  double units_moved(const CanSignal& signal, const SignalReading& from,
                     const SignalReading& to) const noexcept;
  bool plausible(const Step& step) const noexcept;
  bool too_abrupt(const Step& before, const Step& step) const noexcept;
  OdometryIncrement accept(const Sample& to, const Step& step) noexcept;
  OdometryIncrement rebase(const Sample& to, const Step& step) noexcept;
  Covariance2 noise_of(const Step& step) const noexcept;

  WheelOdometrySettings settings_;
  WheelModel model_;
  bool positions_;
  PerWheel resolution_{};  // of a wheel, m or m/s
  CanOpenWatch watch_;
  std::array<Side, kMostWheels> sides_{};
  std::optional<Sample> last_;     // accepted
  std::optional<Step> last_step_;  // that led to last_; none after a start or a gap
  std::optional<Sample> suspect_;  // the newest refused one
  bool booted_ = false;            // counters begin again with the next sample
  WheelOdometryCounters counters_;
};

}  // namespace zonepack
