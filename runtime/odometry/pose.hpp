// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace zonepack {

// base_link in the map, in the plane. Yaw in (-pi, pi], counter-clockwise from x.
struct Pose2 {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;
  friend bool operator==(const Pose2&, const Pose2&) = default;
};

// Of (x, y, yaw), symmetric: m^2, m rad, rad^2.
struct Covariance2 {
  double xx = 0, xy = 0, x_yaw = 0;
  double yy = 0, y_yaw = 0;
  double yaw_yaw = 0;
  friend bool operator==(const Covariance2&, const Covariance2&) = default;
};

// What the pose filter believes at one instant.
struct PoseEstimate {
  std::int64_t t_ns = 0;  // the clock of the cycle
  Pose2 T_map_base;
  Covariance2 covariance;   // in the map
  double speed_m_s = 0;     // forward, from odometry; 0 when that is stale
  double sideways_m_s = 0;  // to the left; robots with mecanum or omni wheels only
  double yaw_rate_rad_s = 0;
  bool valid = false;    // a pose is known at all
  bool trusted = false;  // two absolute fixes agreed through odometry
};

// Where the robot may be while nothing is trusted.
struct PoseHypothesis {
  Pose2 T_map_base;
  Covariance2 covariance;
  std::uint32_t fixes = 0;  // absolute fixes that support it; 0: a given start
};
inline constexpr std::size_t kMaxHypotheses = 4;

}  // namespace zonepack
