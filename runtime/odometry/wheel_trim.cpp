// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/wheel_trim.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/odometry/det_math.hpp"
#include "runtime/odometry/seconds.hpp"

namespace zonepack {
namespace {

// A pair of fixes is long enough after one of these.
constexpr double kLeastWay_m = 1.5, kLeastTurn_rad = 0.5, kLeastTime_s = 3.5;
// Both fixes may be off by what the map is bent between them.
constexpr double kMapSigma_m = 0.02, kMapSigma_rad = 0.002;
// Wheels change, slowly: variance added by a pair.
constexpr double kChange = 1e-8;
constexpr double kLeast = 0.8, kMost = 1.25;

}  // namespace

double WheelTrim::way_sigma() const noexcept { return std::sqrt(way_way_); }
double WheelTrim::turn_sigma() const noexcept { return std::sqrt(turn_turn_); }

OdometryIncrement WheelTrim::trimmed(const OdometryIncrement& increment) const noexcept {
  if (pairs_ == 0) return increment;
  OdometryIncrement out = increment;
  out.motion.pose.x_m *= way_;
  out.motion.pose.y_m *= way_;
  out.motion.pose.yaw_rad = wrap_angle(increment.motion.pose.yaw_rad * turn_);
  out.speed_m_s *= way_;
  out.sideways_m_s *= way_;
  out.yaw_rate_rad_s *= turn_;
  return out;
}

void WheelTrim::learn(const OdometryHistory& history, const UncertainPose& fix,
                      std::uint64_t index) noexcept {
  if (has_fix_ && index_ >= history.oldest() && index <= index_) return;
  bool whole = has_fix_ && index_ >= history.oldest();
  UncertainPose odometry;
  double turned = 0;                    // full turns count
  double by_turn_x = 0, by_turn_y = 0;  // how the place moves as every turn grows by its own size
  for (std::uint64_t i = index_; whole && i < index; ++i) {
    const OdometryHistory::Entry& next = history.at(i + 1);
    const Pose2& step = next.step.pose;
    whole = !next.drift;
    const double c = det_cos(odometry.pose.yaw_rad), s = det_sin(odometry.pose.yaw_rad);
    by_turn_x += (-s * step.x_m - c * step.y_m) * turned;
    by_turn_y += (c * step.x_m - s * step.y_m) * turned;
    odometry = compose(odometry, next.step);
    turned += step.yaw_rad;
  }
  if (whole) {
    const double x = odometry.pose.x_m, y = odometry.pose.y_m;
    const double way = std::sqrt(square(x) + square(y));
    const double seconds = seconds_between(history.at(index_).t_ns, history.at(index).t_ns);
    if (way < kLeastWay_m && std::abs(turned) < kLeastTurn_rad && seconds < kLeastTime_s) return;
    const Pose2 real = between(fix_.pose, fix.pose);
    const Covariance2 &a = fix_.covariance, &b = fix.covariance, &o = odometry.covariance;
    const double yaw_yaw = a.yaw_yaw + b.yaw_yaw + square(kMapSigma_rad);
    bool used = false;
    if (way > 0.1) {
      const double ux = x / way, uy = y / way;
      const double fixes = std::max(a.xx, a.yy) + std::max(b.xx, b.yy) + square(kMapSigma_m);
      used = take({.off = (real.x_m - x) * ux + (real.y_m - y) * uy,
                   .by_way = way / way_,
                   .by_turn = (by_turn_x * ux + by_turn_y * uy) / turn_,
                   .variance = o.xx * ux * ux + 2 * o.xy * ux * uy + o.yy * uy * uy + fixes});
    }
    used = take({.off = wrap_angle(real.yaw_rad - turned),
                 .by_turn = turned / turn_,
                 .variance = o.yaw_yaw + yaw_yaw}) ||
           used;
    if (used) ++pairs_;
    way_way_ += kChange;
    turn_turn_ += kChange;
  }
  has_fix_ = true;
  fix_ = fix;
  index_ = index;
}

bool WheelTrim::take(const Measured& m) noexcept {
  const double to_way = way_way_ * m.by_way + way_turn_ * m.by_turn;
  const double to_turn = way_turn_ * m.by_way + turn_turn_ * m.by_turn;
  const double variance = to_way * m.by_way + to_turn * m.by_turn + m.variance;
  if (!(square(m.off) <= 9 * variance)) return false;
  way_ = std::clamp(way_ + to_way / variance * m.off, kLeast, kMost);
  turn_ = std::clamp(turn_ + to_turn / variance * m.off, kLeast, kMost);
  way_way_ -= to_way * to_way / variance;
  way_turn_ -= to_way * to_turn / variance;
  turn_turn_ -= to_turn * to_turn / variance;
  return true;
}

}  // namespace zonepack
