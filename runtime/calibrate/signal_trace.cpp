// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/signal_trace.hpp"

#include <algorithm>

namespace zonepack {

double SignalTrace::step_to(const SignalReading& reading) const noexcept {
  if (!integer()) return reading.value - last_.value;
  return static_cast<double>(wrapped_difference(reading.raw, last_.raw, signal_.bits.length)) *
         signal_.factor;
}

SignalReading SignalTrace::take(const CanFrame& frame) {
  constexpr double kLongestStep_s = 1;  // a speed says nothing about a longer pause
  const SignalReading reading = read_signal(signal_, frame);
  if (reading.status == SignalReading::Status::kOther) return reading;
  last_refused_ = reading.status == SignalReading::Status::kRefused;
  if (last_refused_) {
    ++refused_;
    return reading;
  }
  if (count_ == 0) {
    first_ns_ = frame.stamp_ns;
    least_ = most_ = reading.value;
  } else {
    const double step = step_to(reading);
    rises_ += step > 0 ? 1 : 0;
    falls_ += step < 0 ? 1 : 0;
    const double seconds = static_cast<double>(frame.stamp_ns - last_ns_) * 1e-9;
    if (position_) {
      moved_ += step;
    } else if (seconds > 0 && seconds <= kLongestStep_s) {
      moved_ += (last_.value + reading.value) / 2 * seconds;
    }
  }
  least_ = std::min(least_, reading.value);
  most_ = std::max(most_, reading.value);
  ++count_;
  last_ = reading;
  last_ns_ = frame.stamp_ns;
  return reading;
}

double SignalTrace::seconds() const noexcept {
  return static_cast<double>(last_ns_ - first_ns_) * 1e-9;
}

bool SignalTrace::only_counts() const noexcept {
  constexpr std::uint64_t kLeastChanges = 50;
  constexpr double kLeast_s = 5;
  const std::uint64_t other_way = std::min(rises_, falls_);
  return changes() >= kLeastChanges && seconds() >= kLeast_s && other_way * 100 <= changes();
}

double SignalTrace::raw_number() const noexcept {
  if (!integer()) return last_.value;
  if (signal_.type == SignalType::kSigned) return static_cast<double>(last_.raw);
  return static_cast<double>(static_cast<std::uint64_t>(last_.raw));
}

}  // namespace zonepack
