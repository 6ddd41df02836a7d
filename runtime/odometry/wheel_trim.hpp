// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/odometry/odometry_history.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {

// By how much the wheels' way and turn are to be multiplied, learned while driving: from pairs of
// absolute fixes, the way and the turn between them are compared with what odometry made of it.
//
// A Kalman filter of two values that start at 1. Each pair gives two measurements: the way along
// the straight line between the fixes, and the turn. Their noise is that of odometry, of both
// fixes and of a map that is bent; what lies outside three sigma is left out.
//
// Real-time: no allocation; learn() goes through the history once.
// Bit-exact: see det_math.hpp.
class WheelTrim {
 public:
  // The motion as it should have been. Unchanged, bit for bit, before anything was learned.
  OdometryIncrement trimmed(const OdometryIncrement& increment) const noexcept;

  // Takes a fix that was used, at entry `index` of a history of trimmed motions.
  void learn(const OdometryHistory& history, const UncertainPose& fix,
             std::uint64_t index) noexcept;

  // The next fix begins a new pair: the entries were renumbered, or the pose was moved.
  void forget_fix() noexcept { has_fix_ = false; }

  // True over reported, and standard deviations.
  double way() const noexcept { return way_; }
  double turn() const noexcept { return turn_; }
  double way_sigma() const noexcept;
  double turn_sigma() const noexcept;
  std::uint64_t pairs() const noexcept { return pairs_; }

 private:
  struct Measured {
    double off = 0;                  // how much more it was than odometry says
    double by_way = 0, by_turn = 0;  // how much a change of each value changes it
    double variance = 0;
  };
  bool take(const Measured& measured) noexcept;

  static constexpr double kFirstVariance = 0.05 * 0.05;

  double way_ = 1, turn_ = 1;
  double way_way_ = kFirstVariance, way_turn_ = 0, turn_turn_ = kFirstVariance;
  std::uint64_t pairs_ = 0;
  bool has_fix_ = false;
  UncertainPose fix_;
  std::uint64_t index_ = 0;  // its entry
};

}  // namespace zonepack
