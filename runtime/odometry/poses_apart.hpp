// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "runtime/odometry/pose.hpp"

namespace zonepack {

// How far two poses are apart, for searches and figures. Not for what zoned decides: the standard
// library's results differ from machine to machine in their last bits.

inline double apart_m(const Pose2& a, const Pose2& b) noexcept {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

// The shorter way round, from -pi to pi.
inline double turn_rad(double from_rad, double to_rad) noexcept {
  return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

inline bool are_within(const Pose2& a, const Pose2& b, double metres, double radians) noexcept {
  return apart_m(a, b) < metres && std::abs(turn_rad(a.yaw_rad, b.yaw_rad)) < radians;
}

}  // namespace zonepack
