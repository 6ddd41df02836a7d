// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/localize/query/localizer.hpp"
#include "runtime/localize/solve/sighting.hpp"
#include "runtime/odometry/poses_apart.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

constexpr double kReach_m = 12;  // between two bases that see the same
constexpr double kMostTurn_rad = 70 * std::numbers::pi / 180;
constexpr std::size_t kStride = 5;  // of the points that are counted
constexpr double kMargin_px = 40;

// Points of a signature that the camera sees, of every kStride-th.
std::uint32_t count_in_view(const MapFeatures& map, const CameraModel& camera,
                            const Eigen::Isometry3d& T_camera_map) {
  const Eigen::Isometry3f T = (T_camera_map * map.T_map_base).cast<float>();
  const Eigen::Isometry3f own = map.T_base_camera.inverse().cast<float>();
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < map.points.size(); i += kStride) {
    const Eigen::Vector3f p_base(map.points[i].x_m, map.points[i].y_m, map.points[i].z_m);
    const Eigen::Vector3f p = T * p_base;
    if (p.z() < 0.2F) continue;
    const double u = camera.cx + camera.fx * static_cast<double>(p.x() / p.z());
    const double v = camera.cy + camera.fy * static_cast<double>(p.y() / p.z());
    if (u < -kMargin_px || v < -kMargin_px || u > camera.width + kMargin_px ||
        v > camera.height + kMargin_px) {
      continue;
    }
    const float ratio = p.squaredNorm() / std::max((own * p_base).squaredNorm(), 1e-4F);
    if (ratio > 0.16F && ratio < 6.25F) ++count;
  }
  return count;
}

}  // namespace

bool in_reach(const Eigen::Isometry3d& T_map_base, const QueryPrior& prior) noexcept {
  const double apart = std::hypot(T_map_base.translation().x() - prior.T_map_base.x_m,
                                  T_map_base.translation().y() - prior.T_map_base.y_m);
  return apart < kReach_m + 3 * position_sigma_m(prior.covariance);
}

Candidates choose_candidates(std::span<const MapFeatures* const> map, const CameraModel& camera,
                             const QueryPrior& prior, std::size_t most) {
  Candidates out;
  // The floor's height where the robot is: of the three nearest signatures.
  std::vector<const MapFeatures*> near;
  const auto apart = [&](const MapFeatures* one) {
    return std::hypot(one->T_map_base.translation().x() - prior.T_map_base.x_m,
                      one->T_map_base.translation().y() - prior.T_map_base.y_m);
  };
  for (const MapFeatures* const one : map) {
    if (one->points.empty() || !in_reach(one->T_map_base, prior)) continue;
    near.push_back(one);
  }
  out.near = static_cast<std::uint32_t>(near.size());
  if (near.empty()) return out;
  const auto closer = [&](const MapFeatures* a, const MapFeatures* b) {
    const double left = apart(a), right = apart(b);
    return left != right ? left < right : a->id < b->id;
  };
  std::sort(near.begin(), near.end(), closer);
  out.nearest = near.front();
  out.nearest_m = apart(out.nearest);
  const std::size_t three = std::min<std::size_t>(3, near.size());
  for (std::size_t i = 0; i < three; ++i) {
    out.floor_z_m += near[i]->T_map_base.translation().z() / static_cast<double>(three);
  }
  const auto turn_of = [&](const MapFeatures* one) {
    return std::abs(turn_rad(prior.T_map_base.yaw_rad, flatten(one->T_map_base).yaw_rad));
  };
  out.nearest_turn_rad = turn_of(out.nearest);

  const Eigen::Isometry3d T_camera_map =
      (lift(prior.T_map_base, out.floor_z_m) * camera.T_base_camera).inverse();
  const double yaw_slack = 2 * std::sqrt(std::max(0.0, prior.covariance.yaw_yaw));
  for (const MapFeatures* const one : near) {
    if (turn_of(one) > kMostTurn_rad + yaw_slack) continue;
    const std::uint32_t count = count_in_view(*one, camera, T_camera_map);
    if (count > 0) out.reach.push_back({one, count});
  }
  std::stable_sort(out.reach.begin(), out.reach.end(),
                   [](const Candidate& a, const Candidate& b) { return a.in_view > b.in_view; });
  out.best.assign(out.reach.begin(), out.reach.begin() + static_cast<std::ptrdiff_t>(
                                                             std::min(most, out.reach.size())));
  double sum = 0, weights = 0;
  for (const Candidate& one : out.best) {
    sum += one.in_view * one.map->T_map_base.translation().z();
    weights += one.in_view;
  }
  if (weights > 0) out.floor_z_m = sum / weights;
  return out;
}

std::array<Pose2, 7> spanning_poses(const QueryPrior& prior) {
  const Covariance2& c = prior.covariance;
  Eigen::Matrix3d all;
  all << c.xx, c.xy, c.x_yaw, c.xy, c.yy, c.y_yaw, c.x_yaw, c.y_yaw, c.yaw_yaw;
  all.diagonal().array() += 1e-12;
  const Eigen::LLT<Eigen::Matrix3d> factor(all);
  const Eigen::Matrix3d root =
      factor.info() == Eigen::Success
          ? Eigen::Matrix3d(factor.matrixL())
          : Eigen::Matrix3d(all.diagonal().cwiseMax(0).cwiseSqrt().asDiagonal());
  std::array<Pose2, 7> out;
  out[0] = prior.T_map_base;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1 : -1;
      Pose2& pose = out[static_cast<std::size_t>(1 + 2 * axis + side)];
      pose = prior.T_map_base;
      pose.x_m += sign * root(0, axis);
      pose.y_m += sign * root(1, axis);
      pose.yaw_rad += sign * root(2, axis);
    }
  }
  return out;
}

}  // namespace zonepack::localize
