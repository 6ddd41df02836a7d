// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/odometry/can_signals.hpp"

namespace zonepack {

// How one signal behaved: its newest value, how far it went, and whether it only ever grew or only
// ever fell. Not for the control thread.
//
// Memory: constant.
class SignalTrace {
 public:
  // Of a position, `moved()` sums the differences of a counter that may wrap; otherwise the
  // signal's value over time.
  SignalTrace(const CanSignal& signal, bool position) : signal_(signal), position_(position) {}

  // Takes a frame; returns what it held of the signal.
  SignalReading take(const CanFrame& frame);

  std::uint64_t count() const noexcept { return count_; }      // readings with a value
  std::uint64_t refused() const noexcept { return refused_; }  // too short, remote, not finite
  bool last_refused() const noexcept { return last_refused_; }
  const SignalReading& last() const noexcept { return last_; }  // the newest with a value
  std::int64_t first_ns() const noexcept { return first_ns_; }
  std::int64_t last_ns() const noexcept { return last_ns_; }
  double seconds() const noexcept;

  // Readings that differ from the one before, and those of them that were larger.
  std::uint64_t changes() const noexcept { return rises_ + falls_; }
  std::uint64_t rises() const noexcept { return rises_; }
  double least() const noexcept { return least_; }
  double most() const noexcept { return most_; }
  // In units of the signal, or for a speed in units of the signal times seconds; signed.
  double moved() const noexcept { return moved_; }

  // Changes nearly always in one direction, often enough and long enough that no speed does so.
  bool only_counts() const noexcept;

  // The newest reading as a number; integers without a sign bit as they are.
  double raw_number() const noexcept;
  bool integer() const noexcept {
    return signal_.type == SignalType::kSigned || signal_.type == SignalType::kUnsigned;
  }
  const CanSignal& signal() const noexcept { return signal_; }

 private:
  double step_to(const SignalReading& reading) const noexcept;

  CanSignal signal_;
  bool position_;
  std::uint64_t count_ = 0, refused_ = 0, rises_ = 0, falls_ = 0;
  bool last_refused_ = false;
  SignalReading last_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  double least_ = 0, most_ = 0, moved_ = 0;
};

}  // namespace zonepack
