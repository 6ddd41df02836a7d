// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/calibrate/wheel_hints.hpp"

// The part of wheel_hints() that compares a drive with what the robot did: which signal is which
// wheel's, which counts backwards, and by how much all are off.
namespace zonepack {

// A left and a right wheel, over windows whose truth is known. A wheel's sign and scale come from
// windows in which the robot drives straight, and which wheel is which from those in which it
// turns; the median over the windows decides, so that single outliers do not.
std::vector<WheelHint> side_hints(const Settings& settings, const WheelEvidence& evidence);

// The same for the signals of a twist.
std::vector<WheelHint> twist_hints(const Settings& settings, const WheelEvidence& evidence);

}  // namespace zonepack
