// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/calibrate/wheel_hints.hpp"

// The part of wheel_hints() that compares the signals with what somebody does with the robot.
namespace zonepack {

// How far a signal of the model went while somebody moved the robot.
struct SignalMove {
  SignalKey key;
  double moved_m = 0;  // by the present settings; rad of a yaw rate or a steering angle
  bool moved = false;
  bool seen = false;  // any frame brought it
};

// One motion of which its direction, and perhaps its amount, is known.
std::vector<WheelHint> expectation_hints(const Settings& settings, const ExpectedMotion& expected,
                                         const std::vector<SignalMove>& moves);

}  // namespace zonepack
