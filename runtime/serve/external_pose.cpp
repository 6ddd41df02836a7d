// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/external_pose.hpp"

#include <cmath>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

bool is_covariance(const wire::Covariance& c) noexcept {
  const auto is_variance = [](double v) { return std::isfinite(v) && v > 0; };
  const auto agree = [](double off, double a, double b) { return off * off <= a * b; };
  return is_variance(c.xx()) && is_variance(c.yy()) && is_variance(c.yaw_yaw()) &&
         agree(c.xy(), c.xx(), c.yy()) && agree(c.x_yaw(), c.xx(), c.yaw_yaw()) &&
         agree(c.y_yaw(), c.yy(), c.yaw_yaw());
}

// Wraps around instead of overflowing: a stamp that far off is refused by the filter anyway.
std::int64_t minus(std::int64_t a, std::int64_t b) noexcept {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

std::optional<std::int64_t> on_run_clock(wire::Clock clock, std::int64_t stamp_ns,
                                         const ClockReading& now) noexcept {
  switch (clock) {
    case wire::Clock::Run:
      return stamp_ns;
    case wire::Clock::Monotonic:
      return minus(now.run_ns, minus(now.monotonic_ns, stamp_ns));
    case wire::Clock::Realtime:
      return minus(stamp_ns, now.offset_ns);
  }
  return std::nullopt;
}

}  // namespace

std::optional<PoseCorrection> correction_of(const wire::GivePose& given,
                                            const ClockReading& now) noexcept {
  const wire::Pose& pose = *given.pose();
  const wire::Covariance& covariance = *given.covariance();
  const auto stamp_ns = on_run_clock(given.clock(), given.stamp_ns(), now);
  if (!stamp_ns || !std::isfinite(pose.x()) || !std::isfinite(pose.y()) ||
      !(std::abs(pose.yaw()) <= kLargestAngle_rad) || !is_covariance(covariance)) {
    return std::nullopt;
  }
  PoseCorrection correction;
  correction.stamp_ns = *stamp_ns;
  correction.received_ns = now.run_ns;
  correction.T_map_base = {pose.x(), pose.y(), wrap_angle(pose.yaw())};
  correction.sigma_x_m = std::sqrt(covariance.xx());
  correction.sigma_y_m = std::sqrt(covariance.yy());
  correction.sigma_yaw_rad = std::sqrt(covariance.yaw_yaw());
  correction.view_m = std::isfinite(given.view()) ? given.view() : 0;
  return correction;
}

}  // namespace zonepack
