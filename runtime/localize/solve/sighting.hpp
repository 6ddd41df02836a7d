// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/odometry/pose.hpp"

namespace zonepack::localize {

// A point of the map, and where the image may show it.
struct Sighting {
  Eigen::Vector3d p_map;
  Eigen::Vector2d px;                    // as an ideal pinhole camera sees it
  std::uint32_t feature = 0;             // of the image
  double weight = 1;                     // how sure the match is
  std::uint32_t signature = 0, row = 0;  // of the map: place in the list of candidates, feature
};

// A pose of the plane at this height, level.
inline Eigen::Isometry3d lift(const Pose2& T_map_base, double floor_z_m) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = Eigen::AngleAxisd(T_map_base.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  out.translation() = Eigen::Vector3d(T_map_base.x_m, T_map_base.y_m, floor_z_m);
  return out;
}

// Heading and place of a pose in space: where its x axis points.
inline Pose2 flatten(const Eigen::Isometry3d& T_map_base) {
  const Eigen::Vector3d ahead = T_map_base.linear().col(0);
  return {T_map_base.translation().x(), T_map_base.translation().y(),
          std::atan2(ahead.y(), ahead.x())};
}

inline constexpr double kLeastDepth = 0.05;  // metres before the camera

// Squared distance in pixels between where the camera sees p_camera and px; huge behind it.
inline double squared_error(const CameraModel& camera, const Eigen::Vector3d& p_camera,
                            const Eigen::Vector2d& px) noexcept {
  if (p_camera.z() < kLeastDepth) return 1e12;
  const double dx = camera.cx + camera.fx * p_camera.x() / p_camera.z() - px.x();
  const double dy = camera.cy + camera.fy * p_camera.y() / p_camera.z() - px.y();
  return dx * dx + dy * dy;
}

}  // namespace zonepack::localize
