// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/file/byte_codec.hpp"
#include "runtime/pack_format/file/checksum.hpp"

namespace zonepack {

// Whether numbers from a file can be a robot's pose and its standard deviations.
inline bool is_place(const Pose2& pose, double sigma_m, double sigma_rad) noexcept {
  const auto within = [](double value, double least, double most) {
    return value >= least && value <= most;  // false for nan
  };
  constexpr double kFar_m = 1e7, kLargestAngle = 7;
  return within(pose.x_m, -kFar_m, kFar_m) && within(pose.y_m, -kFar_m, kFar_m) &&
         within(pose.yaw_rad, -kLargestAngle, kLargestAngle) && within(sigma_m, 0, kFar_m) &&
         within(sigma_rad, 0, kFar_m);
}

// a + b and a - b modulo 2^64: deltas of stamps that may be anything.
constexpr std::int64_t wrapped_add(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
constexpr std::int64_t wrapped_sub(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

}  // namespace zonepack
