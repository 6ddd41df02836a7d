// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/calibrate/wheel_hints.hpp"

namespace zonepack {

// Which setting explains that the wheels report `times` the true distance (over 0, not near 1): a
// unit of another name, a gear, the pole pairs, the edges of an encoder, else a radius, a scale or
// the factor of the signals. `seen` says how that is known: "odometry reports 30.0 m for each metre
// of the true path".
WheelHint scale_hint(const Settings& settings, double times, const std::string& seen);

// The same from nothing but speeds that the robot cannot reach.
WheelHint too_fast_hint(const Settings& settings, double usual_speed_m_s, const std::string& seen);

// The same for what a twist's forward speed (or yaw rate) reports.
WheelHint twist_hint(const Settings& settings, bool yaw, double times, const std::string& seen);

}  // namespace zonepack
