// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/preload.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/odometry/det_math.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack {
namespace {

constexpr double kNanosecond_s = 1e-9;

// A portal may lie this far off the borders that it joins, and a door may be a little wider than
// drawn.
constexpr double kPortalSlack_m = 0.1;

constexpr double kLeastStep_m = 0.05;

Point2 moved(Point2 from, Point2 direction, double distance_m) noexcept {
  return {from.x_m + direction.x_m * distance_m, from.y_m + direction.y_m * distance_m};
}

// Rotated counter-clockwise by a positive angle, given its cosine and sine.
Point2 turned(Point2 direction, Point2 rotation) noexcept {
  return {direction.x_m * rotation.x_m - direction.y_m * rotation.y_m,
          direction.x_m * rotation.y_m + direction.y_m * rotation.x_m};
}

Point2 unit(double angle_rad) noexcept { return {det_cos(angle_rad), det_sin(angle_rad)}; }

// Whether the piece of path leaves through the exit, whose segment is longer by `slack_m` at both
// ends.
bool leaves_through(const Exit& exit, Point2 from, Point2 to, double slack_m) noexcept {
  if (dot(to - from, exit.outward) <= 0) return false;
  const double before = dot(from - exit.segment.p, exit.outward);
  const double after = dot(to - exit.segment.p, exit.outward);
  if (before > 0 || after <= 0) return false;
  const Point2 meet = moved(from, to - from, before / (before - after));
  const Point2 span = exit.segment.q - exit.segment.p;
  const double length = std::sqrt(dot(span, span));
  const double place = dot(meet - exit.segment.p, span) / length;
  return place >= -slack_m && place <= length + slack_m;
}

bool sooner(const Approach& a, const Approach& b) noexcept {
  if (a.ahead != b.ahead) return a.ahead;
  return a.entry_s != b.entry_s ? a.entry_s < b.entry_s : a.zone < b.zone;
}

}  // namespace

Preload::Preload(const ZoneGraph& graph, std::span<const float> load_s,
                 const PreloadSettings& settings)
    : graph_(graph), load_s_(load_s), settings_(settings) {
  for (const float load : load_s) longest_load_s_ = std::max(longest_load_s_, load);
}

void Preload::restart() noexcept {
  count_ = 0;
  moved_ = false;
  speed_m_s_ = 0;
  sideways_m_s_ = 0;
  yaw_rate_rad_s_ = 0;
}

double Preload::speed() const noexcept {
  if (sideways_m_s_ == 0) return std::abs(speed_m_s_);
  return std::sqrt(speed_m_s_ * speed_m_s_ + sideways_m_s_ * sideways_m_s_);
}

void Preload::smooth(const PoseEstimate& pose) noexcept {
  const double dt_s = static_cast<double>(pose.t_ns - last_ns_) * kNanosecond_s;
  const double weight = moved_ ? dt_s / (settings_.motion_average_s + dt_s) : 1.0;
  speed_m_s_ += weight * (pose.speed_m_s - speed_m_s_);
  sideways_m_s_ += weight * (pose.sideways_m_s - sideways_m_s_);
  yaw_rate_rad_s_ += weight * (pose.yaw_rate_rad_s - yaw_rate_rad_s_);
  last_ns_ = pose.t_ns;
  moved_ = true;
}

void Preload::update(const PoseEstimate& pose, ZoneId zone) noexcept {
  if (!pose.valid || zone == kNoZone || settings_.off) return;
  smooth(pose);
  const Point2 point{pose.T_map_base.x_m, pose.T_map_base.y_m};
  const double three_sigma_m = 3 * position_sigma_m(pose.covariance);
  for (const Exit& exit : graph_.exits(zone)) {
    if (distance_m(exit.segment, point) <= three_sigma_m) see({exit.to, false, 0, pose.t_ns});
  }
  const bool standing = speed() < settings_.standing_m_s;
  if (!standing) follow_path(pose, zone, three_sigma_m + settings_.margin_m);

  const auto hold_ns = static_cast<std::int64_t>(settings_.hold_s * 1e9);
  const auto end = std::remove_if(held_.begin(), held_.begin() + count_, [&](const Approach& held) {
    return held.zone == zone || (!standing && pose.t_ns - held.seen_ns > hold_ns);
  });
  count_ = static_cast<std::size_t>(end - held_.begin());
  for (std::size_t i = 1; i < count_; ++i) {
    for (std::size_t k = i; k > 0 && sooner(held_[k], held_[k - 1]); --k) {
      std::swap(held_[k], held_[k - 1]);
    }
  }
}

const Exit* Preload::exit_on(ZoneId zone, Point2 from, Point2 to, double slack_m) const noexcept {
  for (const Exit& exit : graph_.exits(zone)) {
    if (leaves_through(exit, from, to, slack_m)) return &exit;
  }
  return nullptr;
}

void Preload::follow_path(const PoseEstimate& pose, ZoneId zone, double margin_m) noexcept {
  const double speed = this->speed();
  const double reach_m =
      std::min(settings_.most_reach_m, speed * static_cast<double>(longest_load_s_) + margin_m);
  const double step_m = std::max(kLeastStep_m, reach_m / kMaxSteps);
  const double turn_rad = yaw_rate_rad_s_ / speed * step_m;
  const double slack_m = margin_m - settings_.margin_m + kPortalSlack_m;

  Point2 direction = unit(pose.T_map_base.yaw_rad);
  if (sideways_m_s_ != 0) {
    direction = turned(direction, {speed_m_s_ / speed, sideways_m_s_ / speed});
  } else if (speed_m_s_ < 0) {
    direction = {-direction.x_m, -direction.y_m};
  }
  Point2 at = moved({pose.T_map_base.x_m, pose.T_map_base.y_m}, direction, -kPortalSlack_m);
  // The chord of an arc points half a step's turn ahead of its start.
  direction = turned(direction, unit(turn_rad / 2));
  const Point2 rotation = unit(turn_rad);
  double done_m = -kPortalSlack_m;
  double turned_rad = 0;
  int hops = 0;
  for (int step = 0; step < kMaxSteps && done_m < reach_m && hops < kMaxHops; ++step) {
    const double length_m = step == 0 ? step_m + kPortalSlack_m : step_m;
    const Point2 next = moved(at, direction, length_m);
    done_m += length_m;
    const double entry_m = std::max(0.0, done_m - step_m);
    const Exit* exit = nullptr;
    while (hops < kMaxHops && (exit = exit_on(zone, at, next, slack_m)) != nullptr) {
      if (entry_m <= speed * static_cast<double>(load_s_[exit->to]) + margin_m) {
        see({exit->to, true, entry_m / speed, pose.t_ns});
      }
      zone = exit->to;
      ++hops;
    }
    at = next;
    turned_rad += std::abs(turn_rad);
    if (turned_rad < settings_.most_turn_rad) direction = turned(direction, rotation);
  }
}

void Preload::see(const Approach& seen) noexcept {
  const auto end = held_.begin() + count_;
  auto place = std::find_if(held_.begin(), end,
                            [&](const Approach& held) { return held.zone == seen.zone; });
  if (place != end) {
    if (place->seen_ns != seen.seen_ns || sooner(seen, *place)) *place = seen;
    return;
  }
  if (count_ < kMaxApproaches) {
    held_[count_++] = seen;
    return;
  }
  place = std::max_element(held_.begin(), end, sooner);
  if (sooner(seen, *place)) *place = seen;
}

}  // namespace zonepack
