// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "runtime/odometry/fix_candidates.hpp"
#include "runtime/odometry/fix_consistency.hpp"
#include "runtime/odometry/odometry_history.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/odometry/wheel_trim.hpp"

namespace zonepack {

// An absolute fix from a localizer: base_link in the map at `stamp_ns`, known at `received_ns`.
struct PoseCorrection {
  std::int64_t stamp_ns = 0;
  std::int64_t received_ns = 0;
  Pose2 T_map_base;
  double sigma_x_m = 0;
  double sigma_y_m = 0;
  double sigma_yaw_rad = 0;
  // How far ahead a localizer sees that reads the map in memory: zones in its view are then kept
  // too where they fit. 0: it reads none. The filter does not use it.
  double view_m = 0;
};

// What became of a fix.
enum class CorrectionVerdict : std::uint8_t {
  kUsed,           // fused into the trusted pose
  kHypothesis,     // kept as one of the places where the robot may be
  kTrusted,        // agreed with an earlier fix: the pose is trusted from here on
  kReinitialised,  // the last of a run of rejected fixes that agree: the pose was moved to them
  kReset,          // accepted unconditionally: the pose was moved there
  kOutlier,        // refused by the gate
  kTooOld,         // from before the history
  kFromFuture,     // stamped after now
  kInvalid,        // not finite, no angle in radians, beyond any map, or a sigma not over 0
};
const char* to_string(CorrectionVerdict verdict) noexcept;

// True for the first five.
bool is_used(CorrectionVerdict verdict) noexcept;

struct PoseFilterSettings {
  double gate_chi2 = 16.27;      // squared Mahalanobis distance; 3 dof, 99.9 %
  double history_s = 5;          // how late a fix may come
  double history_step_s = 0.02;  // shorter odometry steps share an entry of the history
  double future_tolerance_s = 0.05;
  double min_sigma_m = 0.005;  // a fix is never believed to be better than this
  double min_sigma_rad = 0.001;
  std::uint32_t reinit_fixes = 3;  // agreeing rejected fixes that move a trusted pose
  double start_sigma_m = 0.5;      // of a start pose that was given or restored
  double start_sigma_rad = 0.2;
  double drift_sigma_m_per_sqrt_s = 0.3;  // growth while odometry is stale
  double drift_sigma_rad_per_sqrt_s = 0.3;
  double speed_filter_s = 0.1;  // time constant of the speeds in the estimate
  double extrapolate_s = 0.1;   // how far the newest increment is carried on at most
};

struct PoseFilterCounters {
  std::uint64_t used = 0;      // fixes with a verdict that is_used()
  std::uint64_t rejected = 0;  // all others; of these:
  std::uint64_t outliers = 0, too_old = 0, from_future = 0, invalid = 0;
  std::uint64_t reinitialised = 0;
};

// Extended Kalman filter on SE(2): odometry increments, and absolute fixes that come late and are
// sometimes wrong.
//
// A fix acts at its stamp: the history keeps every increment, every state and every fix that was
// used, and replays them from there, so the result is the same as if nothing had come late. Until
// two fixes agree through odometry, nothing is trusted and each fix is a hypothesis of its own.
// Once trusted, fixes outside the gate are refused; when reinit_fixes of them agree with each
// other, with none accepted in between, the filter moves there: it cannot be locked out. When as
// many agree in between accepted ones, trust is suspended and both places are listed.
//
// Real-time: all memory is taken in the constructor. predict() is O(1); correct() and the end of a
// pause go through the history at most 2 * kMaxHypotheses + 2 times (252 entries with the default
// settings).
// Threads: one.
// Bit-exact: see det_math.hpp.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterSettings& settings);

  // A start pose that was given or restored: a guess, not trusted. Forgets everything else.
  void start_at(std::int64_t t_ns, const Pose2& T_map_base) noexcept;
  void start_at(std::int64_t t_ns, const Pose2& T_map_base, double sigma_m,
                double sigma_rad) noexcept;

  // Gives up all that is believed: no pose is known until a fix comes. The wheels' history stays,
  // so that a fix may still come late.
  void forget() noexcept;

  void predict(const OdometryIncrement& reported) noexcept;

  // Once per cycle while odometry is stale: uncertainty grows with the time since the newest
  // increment.
  void drift_until(std::int64_t now_ns) noexcept;

  CorrectionVerdict correct(const PoseCorrection& fix, std::int64_t now_ns) noexcept;

  // A fix that is certain, such as a contact at a known place: the pose is moved there and trusted,
  // whatever was believed before. kReset, or a refusal for its stamp or its numbers.
  CorrectionVerdict reset(const PoseCorrection& fix, std::int64_t now_ns) noexcept;

  // The pose at now_ns, carried on from the newest increment with its speed while odometry is
  // fresh.
  PoseEstimate estimate(std::int64_t now_ns) const noexcept;

  // All places the robot may be, best first: one when trusted, none before anything is
  // known.
  std::span<const PoseHypothesis> hypotheses() const noexcept;

  const PoseFilterCounters& counters() const noexcept { return counters_; }

  // What fixes of a localizer that sees ahead (view_m) taught about the wheels.
  const WheelTrim& wheel_trim() const noexcept { return trim_; }
  const FixConsistency& fix_consistency() const noexcept { return consistency_; }

 private:
  bool is_plausible(const PoseCorrection& fix) const noexcept;
  UncertainPose measured(const PoseCorrection& fix) const noexcept;
  UncertainPose motion_since_newest(double seconds) const noexcept;
  void append(std::int64_t t_ns, const UncertainPose& step, bool drift) noexcept;
  bool may_extend_newest(std::int64_t t_ns, bool drift) const noexcept;
  void make_room() noexcept;
  void split_drift(std::uint64_t index, std::int64_t t_ns) noexcept;
  void bridge_pause(const OdometryIncrement& increment) noexcept;
  bool is_just_before_start(std::int64_t stamp_ns) const noexcept;
  CorrectionVerdict count(CorrectionVerdict verdict) noexcept;
  struct Placed {
    UncertainPose pose{};                                  // of the fix, at the entry
    std::uint64_t index = 0;                               // of the entry
    CorrectionVerdict refused = CorrectionVerdict::kUsed;  // or why it has no place
  };
  Placed find_place(const PoseCorrection& fix, std::int64_t now_ns) noexcept;
  CorrectionVerdict place(const UncertainPose& fix, std::uint64_t index) noexcept;
  CorrectionVerdict support(const UncertainPose& fix, std::uint64_t index) noexcept;
  void adopt(const FixCandidates::Candidate& candidate) noexcept;
  void list_hypotheses() noexcept;

  PoseFilterSettings settings_;
  OdometryHistory history_;
  std::uint64_t valid_from_ = 0;  // when trusted: the first entry whose state is the filter's
  bool trusted_ = false;
  FixCandidates candidates_;  // untrusted: hypotheses; trusted: runs of refused fixes that agree
  std::array<PoseHypothesis, kMaxHypotheses> hypotheses_;
  std::size_t hypothesis_count_ = 0;
  double speed_m_s_ = 0;
  double sideways_m_s_ = 0;
  double yaw_rate_rad_s_ = 0;
  double lost_speed_m_s_ = 0;  // when odometry was last fresh
  double lost_yaw_rate_rad_s_ = 0;
  PoseFilterCounters counters_;
  WheelTrim trim_;
  FixConsistency consistency_;
};

}  // namespace zonepack
