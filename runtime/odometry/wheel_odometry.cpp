// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_odometry.hpp"

#include <algorithm>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

using Status = SignalReading::Status;

constexpr double kSecondsPerNs = 1e-9;

double magnitude(double value) noexcept { return value < 0 ? -value : value; }
double square(double value) noexcept { return value * value; }

bool is_integer(const CanSignal& signal) noexcept {
  return signal.type == SignalType::kSigned || signal.type == SignalType::kUnsigned;
}

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(to_ns - from_ns) * kSecondsPerNs;
}

}  // namespace

WheelOdometry::WheelOdometry(const WheelOdometrySettings& settings) noexcept
    : settings_(settings),
      resolution_left_(is_integer(settings.left) ? magnitude(settings.left.factor) : 0),
      resolution_right_(is_integer(settings.right) ? magnitude(settings.right.factor) : 0) {
  ZP_REQUIRE(is_valid(settings.left) && is_valid(settings.right));
  if (settings.model != OdometryModel::kTwist) {
    resolution_left_ *= settings.metres_per_unit;
    resolution_right_ *= settings.metres_per_unit;
  }
}

std::optional<WheelOdometry::Sample> WheelOdometry::complete_sample(
    const CanFrame& frame) noexcept {
  const SignalReading left = read_signal(settings_.left, frame);
  const SignalReading right = read_signal(settings_.right, frame);
  if (left.status == Status::kOther && right.status == Status::kOther) return std::nullopt;
  ++counters_.frames;
  if (left.status == Status::kRefused || right.status == Status::kRefused) {
    ++counters_.rejected;
    return std::nullopt;
  }
  if (left.status == Status::kValue) left_ = {frame.stamp_ns, left, true};
  if (right.status == Status::kValue) right_ = {frame.stamp_ns, right, true};
  if (!left_.fresh || !right_.fresh) return std::nullopt;
  if (magnitude(seconds_between(left_.stamp_ns, right_.stamp_ns)) > settings_.gap_s) {
    (left.status == Status::kValue ? right_ : left_).fresh = false;
    return std::nullopt;
  }
  left_.fresh = false;
  right_.fresh = false;
  return Sample{std::max(left_.stamp_ns, right_.stamp_ns), left_.reading, right_.reading};
}

double WheelOdometry::units_moved(const CanSignal& signal, const SignalReading& from,
                                  const SignalReading& to) const noexcept {
  if (!is_integer(signal)) return to.value - from.value;
  return static_cast<double>(wrapped_difference(to.raw, from.raw, signal.bits.length)) *
         signal.factor;
}

WheelOdometry::Step WheelOdometry::step_between(const Sample& from,
                                                const Sample& to) const noexcept {
  Step step;
  step.seconds = seconds_between(from.stamp_ns, to.stamp_ns);
  const double scale = settings_.metres_per_unit;
  if (settings_.model == OdometryModel::kTwist) {
    step.speed_left = to.left.value;
    step.speed_right = to.right.value;
    step.distance_m = (from.left.value + to.left.value) * 0.5 * step.seconds;
    step.turn_rad = (from.right.value + to.right.value) * 0.5 * step.seconds;
    return step;
  }
  double left_m = 0;
  double right_m = 0;
  if (settings_.model == OdometryModel::kDifferentialPositions) {
    left_m = units_moved(settings_.left, from.left, to.left) * scale;
    right_m = units_moved(settings_.right, from.right, to.right) * scale;
    step.speed_left = left_m / step.seconds;
    step.speed_right = right_m / step.seconds;
  } else {
    step.speed_left = to.left.value * scale;
    step.speed_right = to.right.value * scale;
    left_m = (from.left.value + to.left.value) * 0.5 * scale * step.seconds;
    right_m = (from.right.value + to.right.value) * 0.5 * scale * step.seconds;
  }
  step.distance_m = (left_m + right_m) * 0.5;
  step.turn_rad = (right_m - left_m) / settings_.track_m;
  return step;
}

bool WheelOdometry::plausible(const Step& step) const noexcept {
  if (!(step.seconds > 0)) return false;
  // A reading may be off by its resolution at either end.
  const double slack = settings_.model == OdometryModel::kDifferentialPositions
                           ? (resolution_left_ + resolution_right_) / step.seconds
                           : 0;
  double speed = step.speed_left;
  double yaw_rate = step.speed_right;
  if (settings_.model != OdometryModel::kTwist) {
    speed = (step.speed_left + step.speed_right) * 0.5;
    yaw_rate = (step.speed_right - step.speed_left) / settings_.track_m;
  }
  return magnitude(speed) <= settings_.max_speed_m_s + slack &&
         magnitude(yaw_rate) <= settings_.max_yaw_rate_rad_s + slack / settings_.track_m;
}

bool WheelOdometry::too_abrupt(const Step& before, const Step& step) const noexcept {
  const bool positions = settings_.model == OdometryModel::kDifferentialPositions;
  // Mean speeds of two steps lie half of both apart; quantisation adds its own.
  const double seconds = positions ? (before.seconds + step.seconds) * 0.5 : step.seconds;
  const double most = settings_.max_acceleration_m_s2 * seconds;
  const double per_unit = positions ? 1 / before.seconds + 1 / step.seconds : 1;
  const double turn_arm = settings_.model == OdometryModel::kTwist ? settings_.track_m * 0.5 : 1;
  return magnitude(step.speed_left - before.speed_left) > most + resolution_left_ * per_unit ||
         magnitude(step.speed_right - before.speed_right) * turn_arm >
             most + resolution_right_ * turn_arm * per_unit;
}

Covariance2 WheelOdometry::noise_of(const Step& step) const noexcept {
  const WheelOdometrySettings& s = settings_;
  const double distance = magnitude(step.distance_m);
  const double turn = magnitude(step.turn_rad);
  Covariance2 noise;
  noise.xx =
      square(s.sigma_forward_per_sqrt_m) * distance + square(s.sigma_forward_per_sqrt_rad) * turn;
  noise.yy = square(s.sigma_sideways_per_sqrt_m) * distance;
  noise.yaw_yaw =
      square(s.sigma_yaw_per_sqrt_m) * distance + square(s.sigma_yaw_per_sqrt_rad) * turn;
  if (step.seconds > s.gap_s) {
    const bool positions = s.model == OdometryModel::kDifferentialPositions;
    const double sigma = positions ? s.sigma_gap_per_m * (distance + turn * s.track_m * 0.5)
                                   : s.sigma_gap_m_per_s * step.seconds;
    noise.xx += square(sigma);
    noise.yy += square(sigma);
    if (!positions) noise.yaw_yaw += square(s.sigma_gap_rad_per_s * step.seconds);
  }
  return noise;
}

OdometryIncrement WheelOdometry::accept(const Sample& to, const Step& step) noexcept {
  OdometryIncrement increment;
  increment.from_ns = last_->stamp_ns;
  increment.to_ns = to.stamp_ns;
  const bool gap = step.seconds > settings_.gap_s;
  if (gap) ++counters_.gaps;
  last_ = to;
  last_step_ = gap ? std::nullopt : std::optional<Step>(step);
  suspect_.reset();
  increment.motion = {along_arc(step.distance_m, step.turn_rad), noise_of(step)};
  increment.speed_m_s = step.distance_m / step.seconds;
  increment.yaw_rate_rad_s = step.turn_rad / step.seconds;
  return increment;
}

// `step` leads from the suspect; on the way there, unknown, the robot is taken to have gone on as
// before.
OdometryIncrement WheelOdometry::rebase(const Sample& to, const Step& step) noexcept {
  ++counters_.rebased;
  const double apart_s = seconds_between(last_->stamp_ns, suspect_->stamp_ns);
  const double lost_s = apart_s > 0 ? apart_s : settings_.gap_s;
  Step bridged = step;
  if (last_step_ && apart_s > 0 && apart_s <= settings_.gap_s) {
    bridged.distance_m += last_step_->distance_m / last_step_->seconds * apart_s;
    bridged.turn_rad += last_step_->turn_rad / last_step_->seconds * apart_s;
  }
  OdometryIncrement increment = accept(to, bridged);
  last_step_ = step;
  increment.speed_m_s = step.distance_m / step.seconds;
  increment.yaw_rate_rad_s = step.turn_rad / step.seconds;
  const double sigma_m = settings_.sigma_gap_m_per_s * lost_s;
  const double sigma_rad = settings_.sigma_gap_rad_per_s * lost_s;
  increment.motion.covariance.xx += square(sigma_m);
  increment.motion.covariance.yy += square(sigma_m);
  increment.motion.covariance.yaw_yaw += square(sigma_rad);
  return increment;
}

std::optional<OdometryIncrement> WheelOdometry::take(const CanFrame& frame) noexcept {
  const std::optional<Sample> sample = complete_sample(frame);
  if (!sample) return std::nullopt;
  if (!last_) {
    last_ = sample;
    return std::nullopt;
  }
  const Step step = step_between(*last_, *sample);
  if (plausible(step)) {
    if (!last_step_ || step.seconds > settings_.gap_s || !too_abrupt(*last_step_, step)) {
      return accept(*sample, step);
    }
  }
  if (suspect_) {
    const Step onward = step_between(*suspect_, *sample);
    if (plausible(onward) && onward.seconds <= settings_.gap_s) {
      const Step to_suspect = step_between(*last_, *suspect_);
      const bool moved =
          plausible(step) && plausible(to_suspect) && !too_abrupt(to_suspect, onward);
      return moved ? accept(*sample, step) : rebase(*sample, onward);
    }
  }
  ++counters_.rejected;
  if (step.seconds > 0) ++counters_.jumps;
  const bool late = step.seconds <= 0 && step.seconds >= -settings_.gap_s;
  if (!late) suspect_ = sample;
  return std::nullopt;
}

bool WheelOdometry::stale(std::int64_t now_ns) const noexcept {
  return !last_ || seconds_between(last_->stamp_ns, now_ns) > settings_.timeout_s;
}

std::optional<std::int64_t> WheelOdometry::newest_ns() const noexcept {
  if (!last_) return std::nullopt;
  return last_->stamp_ns;
}

}  // namespace zonepack
