// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "runtime/odometry/det_math.hpp"
#include "runtime/odometry/pose_filter.hpp"

namespace zonepack {

inline constexpr std::int64_t kMs = 1'000'000;

// A robot that drives in arcs at 50 Hz, its odometry exact, and a filter that follows it.
struct SimulatedDrive {
  explicit SimulatedDrive(const PoseFilterSettings& settings = {}) : filter(settings) {
    truth.push_back({});
  }

  std::int64_t now() const { return static_cast<std::int64_t>(truth.size() - 1) * 20 * kMs; }
  const Pose2& at(std::int64_t t_ns) const {
    return truth[static_cast<std::size_t>(t_ns / (20 * kMs))];
  }

  void step(double distance_m = 0.02, double turn_rad = 0.01) {
    OdometryIncrement increment;
    increment.from_ns = now();
    const Pose2 motion = along_arc(distance_m, turn_rad);
    truth.push_back(compose(truth.back(), motion));
    increment.to_ns = now();
    increment.motion.pose = motion;
    increment.motion.covariance.xx = 1e-4 * std::abs(distance_m);
    increment.motion.covariance.yy = 2.5e-5 * std::abs(distance_m);
    increment.motion.covariance.yaw_yaw = 4e-4 * std::abs(turn_rad);
    increment.speed_m_s = distance_m / 0.02;
    increment.yaw_rate_rad_s = turn_rad / 0.02;
    filter.predict(increment);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  // A fix of the pose at `stamp`, off by (dx, dy, dyaw).
  PoseCorrection fix(std::int64_t stamp_ns, double dx = 0, double dy = 0, double dyaw = 0) const {
    const Pose2& p = at(stamp_ns);
    return {.stamp_ns = stamp_ns,
            .received_ns = now(),
            .T_map_base = {p.x_m + dx, p.y_m + dy, wrap_angle(p.yaw_rad + dyaw)},
            .sigma_x_m = 0.03,
            .sigma_y_m = 0.03,
            .sigma_yaw_rad = 0.01};
  }
  CorrectionVerdict correct(std::int64_t stamp_ns, double dx = 0, double dy = 0, double dyaw = 0) {
    return filter.correct(fix(stamp_ns, dx, dy, dyaw), now());
  }
  CorrectionVerdict correct_now(double dx = 0, double dy = 0, double dyaw = 0) {
    return correct(now(), dx, dy, dyaw);
  }
  void trust() {
    correct_now();
    steps(50);
    correct_now();
    steps(1);
  }
  double error_m() const {
    const Pose2 p = filter.estimate(now()).T_map_base;
    return std::hypot(p.x_m - truth.back().x_m, p.y_m - truth.back().y_m);
  }

  PoseFilter filter;
  std::vector<Pose2> truth;
};

}  // namespace zonepack
