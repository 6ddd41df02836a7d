// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/generated_drive.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace zonepack {
namespace {

constexpr double kLargestInt64 = 9.2e18;

void write_bits(const SignalBits& bits, std::uint64_t raw, CanFrame& frame) noexcept {
  for (std::uint32_t i = 0; i < bits.length; ++i) {
    std::uint32_t bit = bits.start + i;
    std::uint32_t from = i;
    if (bits.order == ByteOrder::kBig) {
      // Counted in the order of sending, from the most significant bit.
      const std::uint32_t sent = bits.start / 8u * 8u + (7u - bits.start % 8u) + i;
      bit = sent / 8u * 8u + (7u - sent % 8u);
      from = bits.length - 1u - i;
    }
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8u));
    std::uint8_t& byte = frame.data[bit / 8u];
    byte = static_cast<std::uint8_t>((raw >> from & 1u) != 0 ? byte | mask : byte & ~mask);
  }
  frame.len = std::max(frame.len, bytes_needed(bits).value_or(64));
}

std::uint64_t raw_of(const CanSignal& signal, double value) noexcept {
  const double scaled = (value - signal.offset) / signal.factor;
  if (signal.type == SignalType::kDouble) return std::bit_cast<std::uint64_t>(scaled);
  if (signal.type == SignalType::kFloat) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(scaled));
  }
  const double bounded = std::clamp(scaled, -kLargestInt64, kLargestInt64);
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(bounded + 0.5)));
}

CanFrame frame_of(std::uint32_t id, bool extended, std::int64_t stamp_ns) noexcept {
  CanFrame frame;
  frame.id = id;
  frame.extended = extended;
  frame.stamp_ns = stamp_ns;
  return frame;
}

}  // namespace

void write_signal(const CanSignal& signal, double value, CanFrame& frame) noexcept {
  for (std::size_t i = 0; i < signal.levels; ++i) {
    const CanSignal::Multiplexer& multiplexer = signal.multiplexers[i];
    if (multiplexer.ranges > 0) write_bits(multiplexer.bits, multiplexer.values[0].least, frame);
  }
  write_bits(signal.bits, raw_of(signal, value), frame);
}

Outcome<void> GeneratedDrive::check(const WheelOdometrySettings& odometry) {
  switch (odometry.model) {
    case OdometryModel::kDifferentialPositions:
    case OdometryModel::kWheelSpeeds:
    case OdometryModel::kTwist:
      break;
    default:
      return failure(
          "drives are generated for differential-positions, wheel-speeds and twist only; play a "
          "log "
          "instead");
  }
  const auto signals = signals_of(odometry);
  for (const CanSignal& a : signals) {
    for (const CanSignal& b : signals) {
      if (a.id == b.id && a.extended == b.extended && a.levels + b.levels > 0 && &a != &b) {
        return failure(
            "drives are not generated for multiplexed signals of one id; play a log instead");
      }
    }
  }
  return {};
}

std::optional<CanFrame> GeneratedDrive::next() noexcept {
  if (made_.empty() && !make_sample()) return std::nullopt;
  const CanFrame frame = made_.front();
  made_.pop_front();
  return frame;
}

// To the next sample.
void GeneratedDrive::move(const DriveLeg& leg) noexcept {
  const auto towards = [this](double wanted, double is, double acceleration) {
    const double most = acceleration * drive_.period_s;
    return is + std::clamp(wanted - is, -most, most);
  };
  speed_m_s_ = towards(leg.speed_m_s, speed_m_s_, kLegAcceleration_m_s2);
  yaw_rate_rad_s_ = towards(leg.yaw_rate_rad_s, yaw_rate_rad_s_, kLegAcceleration_rad_s2);
  const double half_track_m = odometry_.geometry.track_m * odometry_.geometry.slip_factor / 2;
  left_m_ += (speed_m_s_ - yaw_rate_rad_s_ * half_track_m) * drive_.period_s;
  right_m_ += (speed_m_s_ + yaw_rate_rad_s_ * half_track_m) * drive_.period_s;
}

bool GeneratedDrive::make_sample() {
  const std::size_t legs = drive_.legs.size() * drive_.loops;
  if (leg_ >= legs) return false;
  PerWheel values{left_m_, right_m_, 0, 0};
  if (odometry_.model == OdometryModel::kTwist) values = {speed_m_s_, yaw_rate_rad_s_, 0, 0};
  if (odometry_.model == OdometryModel::kWheelSpeeds) {
    const double half_track_m = odometry_.geometry.track_m * odometry_.geometry.slip_factor / 2;
    values = {speed_m_s_ - yaw_rate_rad_s_ * half_track_m,
              speed_m_s_ + yaw_rate_rad_s_ * half_track_m, 0, 0};
  }
  const auto stamp_ns =
      static_cast<std::int64_t>(static_cast<double>(sample_++) * drive_.period_s * 1e9 + 0.5);
  const auto signals = signals_of(odometry_);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    auto frame = std::find_if(made_.begin(), made_.end(), [&](const CanFrame& made) {
      return made.id == signals[i].id && made.extended == signals[i].extended;
    });
    if (frame == made_.end()) {
      frame = made_.insert(made_.end(), frame_of(signals[i].id, signals[i].extended, stamp_ns));
    }
    write_signal(signals[i], values[i] / odometry_.metres_per_unit[i], *frame);
    frame->fd = frame->len > 8;
  }
  for (std::size_t i = 0; i < odometry_.canopen.node_count; ++i) {
    CanFrame alive = frame_of(0x700u + odometry_.canopen.nodes[i], false, stamp_ns);
    alive.len = 1;
    alive.data[0] = 5;  // operational
    made_.push_front(alive);
  }
  if (odometry_.canopen.sync_timeout_s > 0) {
    made_.push_front(frame_of(odometry_.canopen.sync_id, false, stamp_ns));
  }
  const DriveLeg& leg = drive_.legs[leg_ % drive_.legs.size()];
  move(leg);
  in_leg_s_ += drive_.period_s;
  // Half a period of tolerance: a leg ends with the sample nearest to its end.
  if (in_leg_s_ + drive_.period_s / 2 > leg.for_s) {
    in_leg_s_ = 0;
    ++leg_;
  }
  return true;
}

}  // namespace zonepack
