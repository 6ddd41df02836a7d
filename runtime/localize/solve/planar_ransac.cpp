// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/solve/planar_ransac.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace zonepack::localize {
namespace {

// Marsaglia's xorshift64*: the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
  std::size_t below(std::size_t count) {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    const auto high = static_cast<std::uint32_t>((state_ * 0x2545F4914F6CDD1Du) >> 32);
    return static_cast<std::size_t>((std::uint64_t{high} * count) >> 32);
  }

 private:
  std::uint64_t state_;
};

double short_way(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

// Where the ray of a pixel meets the height of its point, in the base; none for rays that are too
// flat to say.
std::optional<Eigen::Vector2d> place_on_floor(const Sighting& sighting, const CameraModel& camera,
                                              double floor_z_m) {
  const Eigen::Vector3d ray =
      camera.T_base_camera.linear() * Eigen::Vector3d((sighting.px.x() - camera.cx) / camera.fx,
                                                      (sighting.px.y() - camera.cy) / camera.fy, 1);
  const Eigen::Vector3d from = camera.T_base_camera.translation();
  const double rise = sighting.p_map.z() - floor_z_m - from.z();
  if (std::abs(ray.z()) < 0.1 || rise / ray.z() < kLeastDepth) return std::nullopt;
  const Eigen::Vector3d at = from + ray * (rise / ray.z());
  return Eigen::Vector2d(at.x(), at.y());
}

struct Score {
  double sum = 0;
  int features = 0;
};

Score score_of(std::span<const Sighting> sightings, const CameraModel& camera,
               const Eigen::Isometry3d& T_camera_map, double threshold2) {
  const Eigen::Matrix3d rotation = T_camera_map.linear();
  const Eigen::Vector3d shift = T_camera_map.translation();
  Score score;
  std::uint32_t feature = 0xFFFFFFFFu;
  double best = threshold2;
  const auto close = [&] {
    if (best < threshold2) {
      score.sum += 1 - best / threshold2;
      ++score.features;
    }
  };
  for (const Sighting& sighting : sightings) {
    if (sighting.feature != feature) {
      close();
      feature = sighting.feature;
      best = threshold2;
    }
    const Eigen::Vector3d at = rotation * sighting.p_map + shift;
    best = std::min(best, squared_error(camera, at, sighting.px));
  }
  close();
  return score;
}

// Takes a pose among the best; false: it is none of them, or close to a better one.
bool keep(const PlanarPose& pose, const RansacOptions& options, std::vector<PlanarPose>& best) {
  const auto close = [&](const PlanarPose& other) {
    return std::hypot(pose.pose.x_m - other.pose.x_m, pose.pose.y_m - other.pose.y_m) <
               options.apart_m &&
           std::abs(short_way(pose.pose.yaw_rad - other.pose.yaw_rad)) < options.apart_rad;
  };
  for (const PlanarPose& other : best) {
    if (other.score >= pose.score && close(other)) return false;
  }
  std::erase_if(best, close);
  if (best.size() >= options.most_poses) {
    if (best.back().score >= pose.score) return false;
    best.pop_back();
  }
  const auto place =
      std::upper_bound(best.begin(), best.end(), pose,
                       [](const PlanarPose& a, const PlanarPose& b) { return a.score > b.score; });
  best.insert(place, pose);
  return true;
}

}  // namespace

std::optional<Pose2> pose_of_two(const Sighting& a, const Sighting& b, const CameraModel& camera,
                                 double floor_z_m, const Pose2& start) {
  Pose2 pose = start;
  const Eigen::Vector2d apart_map = (b.p_map - a.p_map).head<2>();
  const auto at_a = place_on_floor(a, camera, floor_z_m);
  const auto at_b = place_on_floor(b, camera, floor_z_m);
  if (at_a && at_b) {
    const Eigen::Vector2d apart = *at_b - *at_a;
    const double ratio2 = apart.squaredNorm() / std::max(apart_map.squaredNorm(), 1e-6);
    if (ratio2 < 0.36 || ratio2 > 2.8) return std::nullopt;
    pose.yaw_rad =
        short_way(std::atan2(apart_map.y(), apart_map.x()) - std::atan2(apart.y(), apart.x()));
    const Eigen::Vector2d middle = (a.p_map + b.p_map).head<2>() / 2;
    const Eigen::Vector2d seen = Eigen::Rotation2Dd(pose.yaw_rad) * ((*at_a + *at_b) / 2).eval();
    pose.x_m = middle.x() - seen.x();
    pose.y_m = middle.y() - seen.y();
  }
  const Eigen::Isometry3d T_camera_base = camera.T_base_camera.inverse();
  double error2 = 1e12;
  for (int step = 0; step < 6; ++step) {
    const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity() * 1e-6;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    error2 = 0;
    for (const Sighting* const sighting : {&a, &b}) {
      const double dx = sighting->p_map.x() - pose.x_m, dy = sighting->p_map.y() - pose.y_m;
      const Eigen::Vector3d p_base(c * dx + s * dy, -s * dx + c * dy,
                                   sighting->p_map.z() - floor_z_m);
      const Eigen::Vector3d p = T_camera_base * p_base;
      if (p.z() < kLeastDepth) return std::nullopt;
      Eigen::Matrix3d base_by_pose;  // d p_base / d (x, y, yaw)
      base_by_pose << -c, -s, p_base.y(), s, -c, -p_base.x(), 0, 0, 0;
      Eigen::Matrix<double, 2, 3> px_by_camera;
      px_by_camera << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()), 0,
          camera.fy / p.z(), -camera.fy * p.y() / (p.z() * p.z());
      const Eigen::Matrix<double, 2, 3> J = px_by_camera * T_camera_base.linear() * base_by_pose;
      const Eigen::Vector2d r(camera.cx + camera.fx * p.x() / p.z() - sighting->px.x(),
                              camera.cy + camera.fy * p.y() / p.z() - sighting->px.y());
      information += J.transpose() * J;
      gradient += J.transpose() * r;
      error2 += r.squaredNorm();
    }
    const Eigen::Vector3d change = information.ldlt().solve(gradient);
    if (!change.allFinite() || change.head<2>().norm() > 5) return std::nullopt;
    pose.x_m -= change.x();
    pose.y_m -= change.y();
    pose.yaw_rad = short_way(pose.yaw_rad - change.z());
    if (change.cwiseAbs().maxCoeff() < 1e-4) break;
  }
  if (error2 > 2 * 12.0 * 12.0) return std::nullopt;
  return pose;
}

std::vector<PlanarPose> find_planar(std::span<const Sighting> sightings, const CameraModel& camera,
                                    double floor_z_m, const PoseGate& gate,
                                    const RansacOptions& options) {
  if (sightings.size() < 2) return {};
  Random random(options.seed);
  const double threshold2 = options.threshold_px * options.threshold_px;
  const Eigen::Isometry3d T_camera_base = camera.T_base_camera.inverse();
  std::size_t features = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    features += i == 0 || sightings[i].feature != sightings[i - 1].feature ? 1 : 0;
  }
  std::vector<PlanarPose> best;  // best first, and apart
  int needed = options.iterations;
  for (int i = 0; i < needed; ++i) {
    const Sighting& a = sightings[random.below(sightings.size())];
    const Sighting& b = sightings[random.below(sightings.size())];
    if (a.feature == b.feature || (a.px - b.px).squaredNorm() < 20 * 20) continue;
    const auto pose =
        pose_of_two(a, b, camera, floor_z_m, best.empty() ? gate.centre : best.front().pose);
    if (!pose ||
        std::hypot(pose->x_m - gate.centre.x_m, pose->y_m - gate.centre.y_m) > gate.most_m ||
        std::abs(short_way(pose->yaw_rad - gate.centre.yaw_rad)) > gate.most_yaw_rad) {
      continue;
    }
    const Score score =
        score_of(sightings, camera, T_camera_base * lift(*pose, floor_z_m).inverse(), threshold2);
    if (!keep({*pose, score.sum, score.features}, options, best)) continue;
    if (best.front().features == 0) continue;
    // As often as finds two right ones with 99.9 %, were the sightings as good as this pose says.
    const double share = static_cast<double>(best.front().features) / static_cast<double>(features);
    const double miss = std::log(1 - std::min(0.999, share * share * 0.5));
    needed = std::min(options.iterations, std::max(options.least, static_cast<int>(-6.9 / miss)));
  }
  return best;
}

}  // namespace zonepack::localize
