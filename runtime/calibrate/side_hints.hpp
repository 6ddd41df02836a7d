// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/calibrate/wheel_hints.hpp"

// The part of wheel_hints() that compares motion with motion: which signal is which wheel's, which
// counts backwards, and by how much all are off.
namespace zonepack {

// How far a signal of the model went while somebody moved the robot.
struct SignalMove {
  SignalKey key;
  double moved_m = 0;  // by the present settings; rad of a yaw rate or a steering angle
  bool moved = false;
  bool seen = false;  // any frame brought it
};

// A left and a right wheel, over windows whose truth is known. A wheel's sign and scale come from
// windows in which the robot drives straight, and which wheel is which from those in which it
// turns; the median over the windows decides, so that single outliers do not.
std::vector<WheelHint> side_hints(const Settings& settings, const WheelEvidence& evidence);

// The same for the signals of a twist.
std::vector<WheelHint> twist_hints(const Settings& settings, const WheelEvidence& evidence);

// One motion of which its direction, and perhaps its amount, is known.
std::vector<WheelHint> expectation_hints(const Settings& settings, const ExpectedMotion& expected,
                                         const std::vector<SignalMove>& moves);

}  // namespace zonepack
