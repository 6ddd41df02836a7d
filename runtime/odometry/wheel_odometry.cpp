// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "platform/base/require.hpp"
#include "runtime/odometry/seconds.hpp"

namespace zonepack {
namespace {

using Status = SignalReading::Status;

double magnitude(double value) noexcept { return value < 0 ? -value : value; }
bool is_integer(const CanSignal& signal) noexcept {
  return signal.type == SignalType::kSigned || signal.type == SignalType::kUnsigned;
}

// Length of a straight or sideways motion.
double travelled_m(const BodyMotion& motion) noexcept {
  if (motion.sideways_m == 0) return magnitude(motion.forward_m);
  return std::sqrt(square(motion.forward_m) + square(motion.sideways_m));
}

bool is_ackermann(OdometryModel model) noexcept {
  return model == OdometryModel::kAckermannPositions || model == OdometryModel::kAckermannSpeeds;
}

}  // namespace

std::span<const CanSignal> signals_of(const WheelOdometrySettings& settings) noexcept {
  const WheelModel model(settings.model, settings.geometry);
  return {settings.signals.data(), model.signals()};
}

WheelOdometry::WheelOdometry(const WheelOdometrySettings& settings) noexcept
    : settings_(settings),
      model_(settings.model, settings.geometry),
      positions_(reads_positions(settings.model)),
      watch_(settings.canopen) {
  for (std::size_t i = 0; i < model_.signals(); ++i) {
    const CanSignal& signal = settings_.signals[i];
    ZP_REQUIRE(is_valid(signal));
    resolution_[i] = is_integer(signal) ? magnitude(signal.factor) : 0;
    resolution_[i] *= magnitude(settings_.metres_per_unit[i]);
  }
}

// Whether the frame brought at least one good reading.
bool WheelOdometry::note_readings(const CanFrame& frame) noexcept {
  bool any = false;
  bool refused = false;
  std::array<SignalReading, kMostWheels> readings;
  for (std::size_t i = 0; i < model_.signals(); ++i) {
    readings[i] = read_signal(settings_.signals[i], frame);
    any = any || readings[i].status != Status::kOther;
    refused = refused || readings[i].status == Status::kRefused;
  }
  if (!any) return false;
  ++counters_.frames;
  if (!watch_.healthy()) ++counters_.unwatched;
  if (refused && watch_.healthy()) ++counters_.unreadable;
  if (refused || !watch_.healthy()) {
    ++counters_.rejected;
    return false;
  }
  for (std::size_t i = 0; i < model_.signals(); ++i) {
    if (readings[i].status == Status::kValue) sides_[i] = {frame.stamp_ns, readings[i], true};
  }
  return true;
}

std::optional<WheelOdometry::Sample> WheelOdometry::complete_sample(
    const CanFrame& frame) noexcept {
  if (!note_readings(frame)) return std::nullopt;
  bool complete = true;
  for (std::size_t i = 0; i < model_.signals(); ++i) {
    Side& side = sides_[i];
    const bool old = magnitude(seconds_between(side.stamp_ns, frame.stamp_ns)) > settings_.gap_s;
    if (side.fresh && old) side.fresh = false;
    complete = complete && side.fresh;
  }
  if (!complete) return std::nullopt;
  Sample sample;
  sample.stamp_ns = sides_[0].stamp_ns;
  for (std::size_t i = 0; i < model_.signals(); ++i) {
    sample.stamp_ns = std::max(sample.stamp_ns, sides_[i].stamp_ns);
    sample.signals[i] = sides_[i].reading;
    sides_[i].fresh = false;
  }
  return sample;
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
  PerWheel ways{};
  for (std::size_t i = 0; i < model_.signals(); ++i) {
    const double scale = settings_.metres_per_unit[i];
    const SignalReading& before = from.signals[i];
    const SignalReading& after = to.signals[i];
    if (positions_ && i < model_.wheels()) {
      ways[i] = units_moved(settings_.signals[i], before, after) * scale;
      step.speeds[i] = ways[i] / step.seconds;
    } else {
      step.speeds[i] = after.value * scale;
      ways[i] = (before.value + after.value) * 0.5 * scale * step.seconds;
    }
  }
  if (is_ackermann(settings_.model)) {
    const double sign = settings_.metres_per_unit[1];
    ways[1] =
        (from.signals[1].value + to.signals[1].value) * 0.5 * sign + settings_.steering_offset_rad;
    step.speeds[1] += settings_.steering_offset_rad;
    step.steering_rad = ways[1];
  }
  step.motion = model_.motion(ways);
  return step;
}

bool WheelOdometry::plausible(const Step& step) const noexcept {
  constexpr double kMostSteering_rad = 1.4;  // tan grows beyond any use
  if (!(step.seconds > 0) || magnitude(step.steering_rad) > kMostSteering_rad) return false;
  // A reading may be off by its resolution at either end.
  double slack = 0;
  if (positions_) {
    for (std::size_t i = 0; i < model_.wheels(); ++i) slack += resolution_[i];
    slack /= step.seconds;
  }
  const BodyMotion rate = model_.motion(step.speeds);
  return travelled_m(rate) <= settings_.max_speed_m_s + slack &&
         magnitude(rate.turn_rad) <= settings_.max_yaw_rate_rad_s + slack / model_.turn_arm_m();
}

bool WheelOdometry::too_abrupt(const Step& before, const Step& step) const noexcept {
  // Mean speeds of two steps lie half of both apart; quantisation adds its own.
  const double seconds = positions_ ? (before.seconds + step.seconds) * 0.5 : step.seconds;
  const double most = settings_.max_acceleration_m_s2 * seconds;
  const double per_unit = positions_ ? 1 / before.seconds + 1 / step.seconds : 1;
  const auto jumps = [&](std::size_t i, double arm) {
    return magnitude(step.speeds[i] - before.speeds[i]) * arm >
           most + resolution_[i] * arm * per_unit;
  };
  if (settings_.model == OdometryModel::kTwist) {
    return jumps(0, 1) || jumps(1, settings_.geometry.track_m * 0.5);
  }
  for (std::size_t i = 0; i < model_.wheels(); ++i) {
    if (jumps(i, 1)) return true;
  }
  return false;
}

Covariance2 WheelOdometry::noise_of(const Step& step) const noexcept {
  const WheelOdometrySettings& s = settings_;
  const double distance = travelled_m(step.motion);
  const double forward = magnitude(step.motion.forward_m);
  const double sideways = magnitude(step.motion.sideways_m);
  const double turn = magnitude(step.motion.turn_rad);
  const double along = square(s.sigma_forward_per_sqrt_m);
  const double across = square(s.sigma_sideways_per_sqrt_m);
  Covariance2 noise;
  noise.xx = along * forward + square(s.sigma_forward_per_sqrt_rad) * turn + across * sideways;
  noise.yy = across * forward + along * sideways;
  noise.yaw_yaw =
      square(s.sigma_yaw_per_sqrt_m) * distance + square(s.sigma_yaw_per_sqrt_rad) * turn;
  if (step.seconds > s.gap_s) {
    const double sigma = positions_
                             ? s.sigma_gap_per_m * (distance + turn * s.geometry.track_m * 0.5)
                             : s.sigma_gap_m_per_s * step.seconds;
    noise.xx += square(sigma);
    noise.yy += square(sigma);
    if (!positions_) noise.yaw_yaw += square(s.sigma_gap_rad_per_s * step.seconds);
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
  increment.motion = {
      along_arc(step.motion.forward_m, step.motion.sideways_m, step.motion.turn_rad),
      noise_of(step)};
  increment.speed_m_s = step.motion.forward_m / step.seconds;
  increment.sideways_m_s = step.motion.sideways_m / step.seconds;
  increment.yaw_rate_rad_s = step.motion.turn_rad / step.seconds;
  return increment;
}

// `step` leads from the suspect; on the way there, unknown, the robot is assumed to have continued
// as before.
OdometryIncrement WheelOdometry::rebase(const Sample& to, const Step& step) noexcept {
  ++counters_.rebased;
  const double apart_s = seconds_between(last_->stamp_ns, suspect_->stamp_ns);
  const double lost_s = apart_s > 0 ? apart_s : settings_.gap_s;
  Step bridged = step;
  if (last_step_ && apart_s > 0 && apart_s <= settings_.gap_s) {
    const BodyMotion& before = last_step_->motion;
    bridged.motion.forward_m += before.forward_m / last_step_->seconds * apart_s;
    bridged.motion.sideways_m += before.sideways_m / last_step_->seconds * apart_s;
    bridged.motion.turn_rad += before.turn_rad / last_step_->seconds * apart_s;
  }
  OdometryIncrement increment = accept(to, bridged);
  last_step_ = step;
  increment.speed_m_s = step.motion.forward_m / step.seconds;
  increment.sideways_m_s = step.motion.sideways_m / step.seconds;
  increment.yaw_rate_rad_s = step.motion.turn_rad / step.seconds;
  const double sigma_m = settings_.sigma_gap_m_per_s * lost_s;
  const double sigma_rad = settings_.sigma_gap_rad_per_s * lost_s;
  increment.motion.covariance.xx += square(sigma_m);
  increment.motion.covariance.yy += square(sigma_m);
  increment.motion.covariance.yaw_yaw += square(sigma_rad);
  return increment;
}

// Counters were reset: two samples that continue each other are the new starting point.
std::optional<OdometryIncrement> WheelOdometry::start_anew(const Sample& sample) noexcept {
  if (suspect_) {
    const Step onward = step_between(*suspect_, sample);
    if (plausible(onward) && onward.seconds <= settings_.gap_s) {
      booted_ = false;
      return rebase(sample, onward);
    }
  }
  suspect_ = sample;
  ++counters_.rejected;
  return std::nullopt;
}

std::optional<OdometryIncrement> WheelOdometry::take(const CanFrame& frame) noexcept {
  if (watch_.take(frame)) {
    booted_ = last_.has_value();
    suspect_.reset();
  }
  counters_.canopen = watch_.counters();
  const std::optional<Sample> sample = complete_sample(frame);
  if (!sample) return std::nullopt;
  if (!last_) {
    last_ = sample;
    return std::nullopt;
  }
  if (booted_) return start_anew(*sample);
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
  if (step.seconds > 0 && !plausible(step)) ++counters_.too_fast;
  if (!(step.seconds > 0)) ++counters_.not_newer;
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
