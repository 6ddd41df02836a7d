// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/solve/refine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace zonepack::localize {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;  // translation in the map, rotation in the base
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

struct Normal {
  Matrix6 information = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();

  template <int Rows>
  void add(const Eigen::Matrix<double, Rows, 6>& J, const Eigen::Matrix<double, Rows, 1>& r,
           double weight) {
    information.noalias() += J.transpose() * (weight * J);
    gradient.noalias() += J.transpose() * (weight * r);
  }
};

void add_plane(const Eigen::Isometry3d& T, const PlanePrior& prior, Normal& normal) {
  Eigen::Matrix<double, 1, 6> up = Eigen::Matrix<double, 1, 6>::Zero();
  up(2) = 1;
  normal.add<1>(up, Eigen::Matrix<double, 1, 1>(T.translation().z() - prior.floor_z_m),
                1 / (prior.sigma_z_m * prior.sigma_z_m));
  // The map's up, seen in the base, is (0, 0, 1) when level.
  const Eigen::Vector3d up_base = T.linear().transpose() * Eigen::Vector3d::UnitZ();
  Eigen::Matrix<double, 2, 6> tilt = Eigen::Matrix<double, 2, 6>::Zero();
  tilt.block<2, 3>(0, 3) = cross(up_base).topRows<2>();
  normal.add<2>(tilt, up_base.head<2>(), 1 / (prior.sigma_tilt_rad * prior.sigma_tilt_rad));
}

// What one axis of the image adds: it depends on five of the six unknowns.
struct AxisSums {
  std::array<double, 15> information{};  // the upper triangle, row by row
  std::array<double, 5> gradient{};

  void add(const std::array<double, 5>& J, double r, double weight) {
    std::size_t k = 0;
    for (std::size_t row = 0; row < 5; ++row) {
      const double weighted = weight * J[row];
      gradient[row] += weighted * r;
      for (std::size_t column = row; column < 5; ++column) {
        information[k++] += weighted * J[column];
      }
    }
  }

  // `unknowns`: the numbers of the five.
  void add_to(Normal& normal, const std::array<int, 5>& unknowns) const {
    std::size_t k = 0;
    for (std::size_t row = 0; row < 5; ++row) {
      normal.gradient(unknowns[row]) += gradient[row];
      for (std::size_t column = row; column < 5; ++column, ++k) {
        normal.information(unknowns[row], unknowns[column]) += information[k];
        if (column == row) continue;
        normal.information(unknowns[column], unknowns[row]) += information[k];
      }
    }
  }
};

// Summed along the axes of the camera, where half of a projection's derivatives are zero, then
// turned to those of the map and of the base. A shift d and a turn w of the base move a point of
// the camera's frame by q x w - d, q being the way to it from the base's origin.
void add_sightings(std::span<const Sighting> sightings, const CameraModel& camera,
                   const Eigen::Isometry3d& T, double scale_px, double sigma_px, Normal& normal) {
  const Eigen::Isometry3d T_camera_base = camera.T_base_camera.inverse();
  const Eigen::Matrix3d R_camera_base = T_camera_base.linear();
  const Eigen::Matrix3d R_camera_map = R_camera_base * T.linear().transpose();
  const double scale2 = scale_px * scale_px;
  AxisSums across, down;
  for (const Sighting& sighting : sightings) {
    const Eigen::Vector3d q = R_camera_map * (sighting.p_map - T.translation());
    const Eigen::Vector3d p = q + T_camera_base.translation();
    if (p.z() < kLeastDepth) continue;
    const double x = p.x() / p.z(), y = p.y() / p.z();
    const Eigen::Vector2d r(camera.cx + camera.fx * x - sighting.px.x(),
                            camera.cy + camera.fy * y - sighting.px.y());
    const double e2 = r.squaredNorm();
    if (e2 > 16 * scale2) continue;
    const double root = scale2 / (scale2 + e2);  // Geman and McClure
    const double weight = sighting.weight * root * root / (sigma_px * sigma_px);
    const double fx = camera.fx / p.z(), fy = camera.fy / p.z();
    across.add({-fx, fx * x, fx * x * q.y(), -fx * (q.z() + x * q.x()), fx * q.y()}, r.x(), weight);
    down.add({-fy, fy * y, fy * (q.z() + y * q.y()), -fy * y * q.x(), -fy * q.x()}, r.y(), weight);
  }
  Normal along_camera;
  across.add_to(along_camera, {0, 2, 3, 4, 5});
  down.add_to(along_camera, {1, 2, 3, 4, 5});
  Matrix6 turned = Matrix6::Zero();
  turned.topLeftCorner<3, 3>() = R_camera_map;
  turned.bottomRightCorner<3, 3>() = R_camera_base;
  normal.information += turned.transpose() * along_camera.information * turned;
  normal.gradient += turned.transpose() * along_camera.gradient;
}

Eigen::Matrix3d turn_of(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

}  // namespace

Refined refine(std::span<const Sighting> sightings, const CameraModel& camera,
               const Eigen::Isometry3d& start, const PlanePrior& prior,
               const RefineOptions& options) {
  Refined out;
  out.T_map_base = start;
  Eigen::Isometry3d& T = out.T_map_base;
  Matrix6 information = Matrix6::Zero();
  for (int step = 0; step <= options.steps; ++step) {
    const double part = std::min(1.0, step / std::max(1.0, options.steps * 0.6));
    const double scale = options.start_px * std::pow(options.end_px / options.start_px, part);
    Normal normal;
    add_plane(T, prior, normal);
    add_sightings(sightings, camera, T, scale, options.sigma_px, normal);
    information = normal.information;
    if (step == options.steps) break;
    information.diagonal().array() += 1e-6;
    const Vector6 change = -information.ldlt().solve(normal.gradient);
    if (!change.allFinite() || change.head<3>().norm() > 3 || change.tail<3>().norm() > 1)
      return out;
    T.translation() += change.head<3>();
    T.linear() = T.linear() * turn_of(change.tail<3>());
    if (part >= 1 && change.cwiseAbs().maxCoeff() < 1e-6) step = options.steps - 1;
  }
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  const Eigen::LLT<Matrix6> factor(information);
  if (factor.info() != Eigen::Success) return out;
  const Matrix6 all = factor.solve(Matrix6::Identity());
  // Turning about the base's own z axis turns the heading, as long as the robot is nearly level.
  out.covariance = {all(0, 0), all(0, 1), all(0, 5), all(1, 1), all(1, 5), all(5, 5)};
  out.valid = all.allFinite() && all(0, 0) > 0 && all(1, 1) > 0 && all(5, 5) > 0;
  return out;
}

}  // namespace zonepack::localize
