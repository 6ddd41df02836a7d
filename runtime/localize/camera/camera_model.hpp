// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace zonepack::localize {

// Distances in pixels are given for a camera of this focal length, and scale with it.
inline constexpr double kUsualFocal_px = 385;

// A pinhole camera with plumb_bob distortion (OpenCV's k1 k2 p1 p2 k3), and where it sits on the
// robot. Camera frame: x right, y down, z forward. Pixels count from the centre of the upper left
// one.
struct CameraModel {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::array<double, 5> distortion{};
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();

  bool distorted() const noexcept { return distortion != std::array<double, 5>{}; }

  // Where an ideal pinhole camera of the same fx, fy, cx and cy sees what this one sees at `px`.
  // Ten steps of a fixed-point iteration: below 0.01 px for the lenses of indoor robots.
  Eigen::Vector2d undistort(const Eigen::Vector2d& px) const noexcept;
  // The inverse.
  Eigen::Vector2d distort(const Eigen::Vector2d& px) const noexcept;
  // The same two; nothing is to be done for a camera without distortion.
  Eigen::Vector2f ideal(const Eigen::Vector2f& seen_px) const noexcept {
    return distorted() ? undistort(seen_px.cast<double>()).cast<float>().eval() : seen_px;
  }
  Eigen::Vector2f seen(const Eigen::Vector2f& ideal_px) const noexcept {
    return distorted() ? distort(ideal_px.cast<double>()).cast<float>().eval() : ideal_px;
  }
};

}  // namespace zonepack::localize
