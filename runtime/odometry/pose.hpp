// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace zonepack {

// base_link in the map, in the plane. Yaw in (-pi, pi], counter-clockwise from x.
struct Pose2 {
  double x_m = 0;
  double y_m = 0;
  double yaw_rad = 0;
};

// What the pose filter believes at one instant.
struct PoseEstimate {
  std::int64_t t_ns = 0;             // the clock of the cycle
  Pose2 T_map_base;
  std::array<double, 9> covariance{};  // row-major 3x3 of (x, y, yaw): m^2, m rad, rad^2
  double speed_m_s = 0;              // forward, from odometry
  double yaw_rate_rad_s = 0;
  bool valid = false;                // a pose is known at all
  bool trusted = false;              // two absolute fixes agreed through odometry
};

}  // namespace zonepack
