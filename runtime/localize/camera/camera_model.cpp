// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/camera_model.hpp"

namespace zonepack::localize {
namespace {

// Brown's model on normalised coordinates: factor of the radius, and the tangential shift.
struct Lens {
  double radial, dx, dy;
};

Lens lens_at(const std::array<double, 5>& d, double x, double y) noexcept {
  const double r2 = x * x + y * y;
  return {1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4])), 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
          d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

}  // namespace

Eigen::Vector2d CameraModel::undistort(const Eigen::Vector2d& px) const noexcept {
  const double seen_x = (px.x() - cx) / fx, seen_y = (px.y() - cy) / fy;
  double x = seen_x, y = seen_y;
  for (int i = 0; i < 10; ++i) {
    const Lens lens = lens_at(distortion, x, y);
    x = (seen_x - lens.dx) / lens.radial;
    y = (seen_y - lens.dy) / lens.radial;
  }
  return {cx + fx * x, cy + fy * y};
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& px) const noexcept {
  const double x = (px.x() - cx) / fx, y = (px.y() - cy) / fy;
  const Lens lens = lens_at(distortion, x, y);
  return {cx + fx * (x * lens.radial + lens.dx), cy + fy * (y * lens.radial + lens.dy)};
}

}  // namespace zonepack::localize
