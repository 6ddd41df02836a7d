// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/query/candidates.hpp"
#include "runtime/localize/query/matching.hpp"
#include "runtime/localize/solve/sighting.hpp"

namespace zonepack::localize {

inline Eigen::Vector3f point_of(const MapPoint& point) { return {point.x_m, point.y_m, point.z_m}; }

// A pinhole in floats, for the loops over all points.
struct Pinhole {
  float fx, fy, cx, cy, width, height;
  explicit Pinhole(const CameraModel& camera)
      : fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy)),
        width(static_cast<float>(camera.width)),
        height(static_cast<float>(camera.height)) {}
  Eigen::Vector2f project(const Eigen::Vector3f& p) const {
    return {cx + fx * p.x() / p.z(), cy + fy * p.y() / p.z()};
  }
};

// Where one candidate's points are in the image, as far as the prior knows: in a box around where
// the prior itself puts a point, as wide as the prior is vague.
class SearchWindows {
 public:
  SearchWindows(const CameraModel& camera, const QueryPrior& prior, double floor_z_m,
                const MatchOptions& options)
      : pinhole_(camera),
        sigmas_(static_cast<float>(options.sigmas)),
        margin_(static_cast<float>(options.margin_px)) {
    const std::array<Pose2, 7> poses = spanning_poses(prior);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      T_camera_map_[i] = (lift(poses[i], floor_z_m) * camera.T_base_camera).inverse();
    }
  }
  // The candidate that find() is about.
  void use(const MapFeatures& map) {
    for (std::size_t i = 0; i < T_camera_map_.size(); ++i) {
      const Eigen::Isometry3f T = (T_camera_map_[i] * map.T_map_base).cast<float>();
      rotation_[i] = T.linear();
      shift_[i] = T.translation();
    }
  }

  struct Window {
    Eigen::Vector2f middle, half;
  };
  // Of a point in the base of the candidate. False: the camera cannot see it.
  bool find(const Eigen::Vector3f& p_base, Window& out) const {
    const Eigen::Vector3f p = rotation_[0] * p_base + shift_[0];
    if (p.z() < 0.2F) return false;
    out.middle = pinhole_.project(p);
    Eigen::Vector2f square = Eigen::Vector2f::Zero();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Eigen::Vector2f most = Eigen::Vector2f::Zero();
      for (std::size_t i = 1 + 2 * axis; i < 3 + 2 * axis; ++i) {
        const Eigen::Vector3f moved = rotation_[i] * p_base + shift_[i];
        if (moved.z() < 0.1F) {
          most = Eigen::Vector2f::Constant(1e4F);
          break;
        }
        most = most.cwiseMax((pinhole_.project(moved) - out.middle).cwiseAbs());
      }
      square += most.cwiseAbs2();
    }
    out.half = (square.cwiseSqrt() * sigmas_).array() + margin_;
    return out.middle.x() + out.half.x() > 0 && out.middle.y() + out.half.y() > 0 &&
           out.middle.x() - out.half.x() < pinhole_.width &&
           out.middle.y() - out.half.y() < pinhole_.height;
  }

 private:
  Pinhole pinhole_;
  float sigmas_, margin_;
  std::array<Eigen::Isometry3d, 7> T_camera_map_;
  std::array<Eigen::Matrix3f, 7> rotation_;
  std::array<Eigen::Vector3f, 7> shift_;
};

}  // namespace zonepack::localize
