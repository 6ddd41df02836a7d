// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/odometry/det_math.hpp"
#include "runtime/odometry/seconds.hpp"

namespace zonepack {
namespace {

using Verdict = CorrectionVerdict;

constexpr std::uint32_t kFixesForTrust = 2;
constexpr double kDriftStep_s = 0.1;   // how often missing odometry is counted in
constexpr double kDriftEntry_s = 1.0;  // how much of it shares an entry of the history

UncertainPose uncertain(const Pose2& pose, double sigma_m, double sigma_rad) noexcept {
  Covariance2 covariance;
  covariance.xx = square(sigma_m);
  covariance.yy = square(sigma_m);
  covariance.yaw_yaw = square(sigma_rad);
  return {{pose.x_m, pose.y_m, wrap_angle(pose.yaw_rad)}, covariance};
}

std::size_t entries_for(const PoseFilterSettings& settings) {
  return static_cast<std::size_t>(settings.history_s / settings.history_step_s) + 2;
}

}  // namespace

const char* to_string(CorrectionVerdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kUsed:
      return "used";
    case Verdict::kHypothesis:
      return "hypothesis";
    case Verdict::kTrusted:
      return "trusted";
    case Verdict::kReinitialised:
      return "reinitialised";
    case Verdict::kReset:
      return "reset";
    case Verdict::kOutlier:
      return "outlier";
    case Verdict::kTooOld:
      return "too_old";
    case Verdict::kFromFuture:
      return "from_future";
    case Verdict::kInvalid:
      return "invalid";
  }
  return "unknown";
}

bool is_used(CorrectionVerdict verdict) noexcept { return verdict <= Verdict::kReset; }

PoseFilter::PoseFilter(const PoseFilterSettings& settings)
    : settings_(settings), history_(entries_for(settings)) {}

void PoseFilter::start_at(std::int64_t t_ns, const Pose2& T_map_base) noexcept {
  start_at(t_ns, T_map_base, settings_.start_sigma_m, settings_.start_sigma_rad);
}

void PoseFilter::start_at(std::int64_t t_ns, const Pose2& T_map_base, double sigma_m,
                          double sigma_rad) noexcept {
  history_.restart(t_ns);
  trusted_ = false;
  candidates_.guess(history_, uncertain(T_map_base, sigma_m, sigma_rad));
  list_hypotheses();
}

void PoseFilter::forget() noexcept {
  for (std::uint64_t i = history_.oldest(); !history_.empty() && i <= history_.newest(); ++i) {
    history_.at(i).has_fix = false;
  }
  trim_.forget_fix();
  trusted_ = false;
  candidates_.clear();
  list_hypotheses();
}

// Whether a step may become part of the newest entry: short steps share an entry to which nothing
// is anchored.
bool PoseFilter::may_extend_newest(std::int64_t t_ns, bool drift) const noexcept {
  if (history_.newest() == history_.oldest()) return false;
  const OdometryHistory::Entry& last = history_.back();
  if (last.has_fix || last.drift != drift) return false;
  if (trusted_ && history_.newest() == valid_from_) return false;
  if (candidates_.stand_on(history_.newest())) return false;
  const double longest = drift ? kDriftEntry_s : settings_.history_step_s;
  return t_ns <= last.t_ns ||
         seconds_between(history_.at(history_.newest() - 1).t_ns, t_ns) <= longest;
}

// Adds a step to the history and to every place the robot may be.
void PoseFilter::append(std::int64_t t_ns, const UncertainPose& step, bool drift) noexcept {
  candidates_.after_step(step);
  if (may_extend_newest(t_ns, drift)) {
    OdometryHistory::Entry& last = history_.back();
    last.step = compose(last.step, step);
    last.state = compose(history_.at(history_.newest() - 1).state, last.step);
    last.t_ns = std::max(last.t_ns, t_ns);
    return;
  }
  make_room();
  history_.push(std::max(t_ns, history_.back().t_ns), step).drift = drift;
}

// Before an entry is added: what is anchored at the oldest one, which may be dropped, moves to the
// next.
void PoseFilter::make_room() noexcept {
  if (!history_.full()) return;
  candidates_.before_oldest_goes(history_);
  valid_from_ = std::max(valid_from_, history_.oldest() + 1);
}

// A fix in a pause gets an entry of its own, so that it stays at its stamp once the motion is
// known.
void PoseFilter::split_drift(std::uint64_t index, std::int64_t t_ns) noexcept {
  const OdometryHistory::Entry& entry = history_.at(index);
  if (!entry.drift || entry.t_ns == t_ns || index <= history_.oldest() + 1) return;
  if (trusted_ && index == valid_from_) return;
  make_room();
  history_.split(index, t_ns);
  trim_.forget_fix();
  candidates_.after_split(index);
}

// Odometry is back with the motion since it went missing.
void PoseFilter::bridge_pause(const OdometryIncrement& increment) noexcept {
  make_room();
  const std::uint64_t before =
      history_.fill_drift(increment.from_ns, increment.to_ns, increment.motion);
  history_.replay_from(trusted_ ? std::max(before, valid_from_) : before);
  candidates_.after_rewrite(history_);
}

void PoseFilter::predict(const OdometryIncrement& reported) noexcept {
  const OdometryIncrement increment = trim_.trimmed(reported);
  if (history_.empty()) history_.restart(increment.from_ns);
  const double back_s = seconds_between(increment.to_ns, history_.back().t_ns);
  if (back_s > settings_.history_s) {
    // The clock was set back: the pose stays, its past no longer applies.
    const UncertainPose state = history_.back().state;
    history_.restart(increment.to_ns);
    history_.back().state = state;
    valid_from_ = history_.newest();
    candidates_.after_restart(history_);
  }
  if (history_.back().drift && increment.to_ns > increment.from_ns) {
    bridge_pause(increment);
  } else {
    append(increment.to_ns, increment.motion, false);
  }
  const double seconds = std::max(seconds_between(increment.from_ns, increment.to_ns), 0.0);
  const double weight = seconds / (settings_.speed_filter_s + seconds);
  speed_m_s_ += (increment.speed_m_s - speed_m_s_) * weight;
  sideways_m_s_ += (increment.sideways_m_s - sideways_m_s_) * weight;
  yaw_rate_rad_s_ += (increment.yaw_rate_rad_s - yaw_rate_rad_s_) * weight;
  lost_speed_m_s_ =
      sideways_m_s_ == 0 ? speed_m_s_ : std::sqrt(square(speed_m_s_) + square(sideways_m_s_));
  lost_yaw_rate_rad_s_ = yaw_rate_rad_s_;
  list_hypotheses();
}

void PoseFilter::drift_until(std::int64_t now_ns) noexcept {
  speed_m_s_ = 0;
  sideways_m_s_ = 0;
  yaw_rate_rad_s_ = 0;
  if (history_.empty()) return;
  const double seconds = seconds_between(history_.back().t_ns, now_ns);
  if (seconds < kDriftStep_s) return;
  const auto sigma = [seconds](double standing, double moving) {
    return std::sqrt((square(standing) + square(moving)) * seconds);
  };
  append(now_ns,
         uncertain({}, sigma(settings_.drift_sigma_m_per_sqrt_s, lost_speed_m_s_),
                   sigma(settings_.drift_sigma_rad_per_sqrt_s, lost_yaw_rate_rad_s_)),
         true);
  list_hypotheses();
}

bool PoseFilter::is_plausible(const PoseCorrection& fix) const noexcept {
  const auto sound = [](double sigma) { return std::isfinite(sigma) && sigma > 0 && sigma < 1e6; };
  // No map reaches further (the packer's limit of coordinates).
  const auto near = [](double metres) { return std::isfinite(metres) && std::abs(metres) < 1e6; };
  // More is an angle in degrees.
  constexpr double kMostYaw_rad = 2 * kPi + 0.01;
  return near(fix.T_map_base.x_m) && near(fix.T_map_base.y_m) &&
         std::abs(fix.T_map_base.yaw_rad) <= kMostYaw_rad && sound(fix.sigma_x_m) &&
         sound(fix.sigma_y_m) && sound(fix.sigma_yaw_rad);
}

UncertainPose PoseFilter::measured(const PoseCorrection& fix) const noexcept {
  UncertainPose z =
      uncertain(fix.T_map_base, 0, std::max(fix.sigma_yaw_rad, settings_.min_sigma_rad));
  z.covariance.xx = square(std::max(fix.sigma_x_m, settings_.min_sigma_m));
  z.covariance.yy = square(std::max(fix.sigma_y_m, settings_.min_sigma_m));
  return z;
}

UncertainPose PoseFilter::motion_since_newest(double seconds) const noexcept {
  const double s = std::clamp(seconds, 0.0, settings_.extrapolate_s);
  const double distance = speed_m_s_ * s;
  const double sideways = sideways_m_s_ * s;
  const double turn = yaw_rate_rad_s_ * s;
  // A tenth of the way: the speed may change meanwhile.
  const double way = sideways == 0 ? distance : std::sqrt(square(distance) + square(sideways));
  return {along_arc(distance, sideways, turn), uncertain({}, way * 0.1, turn * 0.1).covariance};
}

CorrectionVerdict PoseFilter::count(CorrectionVerdict verdict) noexcept {
  ++(is_used(verdict) ? counters_.used : counters_.rejected);
  if (verdict == Verdict::kOutlier) ++counters_.outliers;
  if (verdict == Verdict::kTooOld) ++counters_.too_old;
  if (verdict == Verdict::kFromFuture) ++counters_.from_future;
  if (verdict == Verdict::kInvalid) ++counters_.invalid;
  if (verdict == Verdict::kReinitialised) ++counters_.reinitialised;
  return verdict;
}

// The first fix of a run may be stamped a moment before the first odometry came.
bool PoseFilter::is_just_before_start(std::int64_t stamp_ns) const noexcept {
  return !history_.full() &&
         seconds_between(stamp_ns, history_.at(history_.oldest()).t_ns) <= settings_.extrapolate_s;
}

PoseFilter::Placed PoseFilter::find_place(const PoseCorrection& fix, std::int64_t now_ns) noexcept {
  if (!is_plausible(fix)) return {.refused = Verdict::kInvalid};
  if (seconds_between(now_ns, fix.stamp_ns) > settings_.future_tolerance_s) {
    return {.refused = Verdict::kFromFuture};
  }
  if (history_.empty()) history_.restart(fix.stamp_ns);
  Placed placed{.pose = measured(fix), .index = history_.newest()};
  if (fix.stamp_ns > history_.back().t_ns) {
    const double ahead = seconds_between(history_.back().t_ns, fix.stamp_ns);
    placed.pose = step_back(placed.pose, motion_since_newest(ahead));
    return placed;
  }
  const std::optional<std::uint64_t> found = history_.find(fix.stamp_ns);
  if (!found && !is_just_before_start(fix.stamp_ns)) return {.refused = Verdict::kTooOld};
  placed.index = found.value_or(history_.oldest());
  if (trusted_ && placed.index < valid_from_) return {.refused = Verdict::kTooOld};
  if (found) {
    split_drift(placed.index, fix.stamp_ns);
    placed.pose = history_.carry_to_entry(placed.pose, fix.stamp_ns, placed.index);
  }
  return placed;
}

CorrectionVerdict PoseFilter::correct(const PoseCorrection& fix, std::int64_t now_ns) noexcept {
  Placed found = find_place(fix, now_ns);
  if (!is_used(found.refused)) return count(found.refused);
  if (fix.view_m > 0 && trusted_) {
    consistency_.add(mahalanobis2(history_.at(found.index).state, found.pose));
    found.pose = consistency_.widened(found.pose);
  }
  const Verdict verdict =
      trusted_ ? place(found.pose, found.index) : support(found.pose, found.index);
  if (fix.view_m > 0 && trusted_ && is_used(verdict)) {
    if (verdict != Verdict::kUsed) trim_.forget_fix();
    trim_.learn(history_, found.pose, found.index);
  }
  list_hypotheses();
  return count(verdict);
}

CorrectionVerdict PoseFilter::reset(const PoseCorrection& fix, std::int64_t now_ns) noexcept {
  const Placed found = find_place(fix, now_ns);
  if (!is_used(found.refused)) return count(found.refused);
  FixCandidates::Candidate here;
  here.anchor = found.index;
  here.at_anchor = found.pose;
  adopt(here);
  list_hypotheses();
  return count(Verdict::kReset);
}

// Trusted: through the gate, or to the candidates.
CorrectionVerdict PoseFilter::place(const UncertainPose& fix, std::uint64_t index) noexcept {
  OdometryHistory::Entry& entry = history_.at(index);
  if (!(mahalanobis2(entry.state, fix) <= settings_.gate_chi2)) return support(fix, index);
  entry.fix = entry.has_fix ? fuse(entry.fix, fix) : fix;
  entry.has_fix = true;
  entry.state = fuse(entry.state, fix);
  history_.replay_from(index);
  candidates_.interrupt(entry.t_ns);
  return Verdict::kUsed;
}

// Untrusted: a hypothesis. Trusted: refused, but a run of such fixes that agree is believed.
CorrectionVerdict PoseFilter::support(const UncertainPose& fix, std::uint64_t index) noexcept {
  const auto confirmed = candidates_.add(history_, fix, index, settings_.gate_chi2, !trusted_);
  const bool believed = confirmed && (trusted_ ? confirmed->run >= settings_.reinit_fixes
                                               : confirmed->fixes >= kFixesForTrust);
  if (!believed) return trusted_ ? Verdict::kOutlier : Verdict::kHypothesis;
  const Verdict verdict = trusted_ ? Verdict::kReinitialised : Verdict::kTrusted;
  adopt(*confirmed);
  return verdict;
}

void PoseFilter::adopt(const FixCandidates::Candidate& candidate) noexcept {
  for (std::uint64_t i = history_.oldest(); i <= history_.newest(); ++i) {
    history_.at(i).has_fix = false;
  }
  valid_from_ = candidate.anchor;
  history_.at(valid_from_).state = candidate.at_anchor;
  history_.replay_from(valid_from_);
  trusted_ = true;
  candidates_.clear();
}

void PoseFilter::list_hypotheses() noexcept {
  if (trusted_) {
    const UncertainPose& newest = history_.back().state;
    hypotheses_[0] = {newest.pose, newest.covariance, kFixesForTrust};
    // Refused fixes keep agreeing in between accepted ones: which are right is unknown.
    hypothesis_count_ = candidates_.list(hypotheses_, 1, settings_.reinit_fixes);
  } else {
    hypothesis_count_ = candidates_.list(hypotheses_, 0, 0);
  }
}

std::span<const PoseHypothesis> PoseFilter::hypotheses() const noexcept {
  return {hypotheses_.data(), hypothesis_count_};
}

PoseEstimate PoseFilter::estimate(std::int64_t now_ns) const noexcept {
  PoseEstimate estimate;
  estimate.t_ns = now_ns;
  estimate.trusted = trusted_ && hypothesis_count_ == 1;
  if (hypothesis_count_ == 0) return estimate;
  const UncertainPose newest = {hypotheses_[0].T_map_base, hypotheses_[0].covariance};
  const UncertainPose now =
      compose(newest, motion_since_newest(seconds_between(history_.back().t_ns, now_ns)));
  estimate.T_map_base = now.pose;
  estimate.covariance = now.covariance;
  estimate.speed_m_s = speed_m_s_;
  estimate.sideways_m_s = sideways_m_s_;
  estimate.yaw_rate_rad_s = yaw_rate_rad_s_;
  estimate.valid = true;
  return estimate;
}

}  // namespace zonepack
