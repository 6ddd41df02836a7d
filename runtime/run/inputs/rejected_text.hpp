// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/odometry/pose_filter.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {

// Why samples were refused, with counts: "312 above max_speed 3 m/s or max_yaw_rate 6 rad/s, 40 not
// newer than the one before". Empty when none was.
std::string rejected_text(const WheelOdometryCounters& counters,
                          const WheelOdometrySettings& settings);

// The same for fixes: "5 outliers, 2 too old".
std::string rejected_text(const PoseFilterCounters& counters);

}  // namespace zonepack
