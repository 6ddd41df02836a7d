// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/odometry/pose.hpp"
#include "runtime/zones/zone_graph.hpp"

// A row of three rooms a (x 0 to 4), b (4 to 8), c (8 to 12), y 0 to 4, with doors at y 1.5 to 2.5,
// and poses in them.
namespace zonepack::testing_support {

inline Polygon box(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

inline ZoneGraph three_rooms() {
  const GraphPortal portals[] = {{0, 1, {{4, 1.5}, {4, 2.5}}}, {1, 2, {{8, 1.5}, {8, 2.5}}}};
  return ZoneGraph({{"a", box(0, 0, 4, 4)}, {"b", box(4, 0, 8, 4)}, {"c", box(8, 0, 12, 4)}},
                   portals);
}

inline PoseEstimate pose_at(double x_m, double y_m, double yaw_rad = 0, double sigma_m = 0.03) {
  PoseEstimate pose;
  pose.T_map_base = {x_m, y_m, yaw_rad};
  pose.covariance.xx = pose.covariance.yy = sigma_m * sigma_m;
  pose.covariance.yaw_yaw = 1e-4;
  pose.valid = true;
  pose.trusted = true;
  return pose;
}

}  // namespace zonepack::testing_support
