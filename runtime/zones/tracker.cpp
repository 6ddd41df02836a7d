// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/tracker.hpp"

#include <algorithm>

#include "runtime/odometry/se2.hpp"

namespace zonepack {
namespace {

// Portal ends may lie a little off the borders that they join.
constexpr double kPortalOffBorder_m = 0.2;

}  // namespace

ZoneTracker::ZoneTracker(const ZoneGraph& graph, const TrackerSettings& settings)
    : graph_(graph), settings_(settings) {}

bool ZoneTracker::portal_leads_to(ZoneId to, Point2 point, double reach_m) const noexcept {
  const auto exits = graph_.exits(zone_);
  return std::any_of(exits.begin(), exits.end(), [&](const Exit& exit) {
    return exit.to == to && distance_m(exit.segment, point) <= reach_m;
  });
}

void ZoneTracker::confirm(ZoneId zone, double reach_m) noexcept {
  if (zone != zone_) {
    confirmed_from_ = zone_;
    confirmed_reach_m_ = reach_m;
    zone_ = zone;
  }
  restart_ = false;
}

bool ZoneTracker::keeps_confirmed(Point2 point, double sigma_m) noexcept {
  if (confirmed_from_ == kNoZone) return false;
  if (portal_leads_to(confirmed_from_, point, confirmed_reach_m_ + 3 * sigma_m)) return true;
  confirmed_from_ = kNoZone;
  return false;
}

bool ZoneTracker::update(const PoseEstimate& pose) noexcept {
  if (!pose.valid) return false;
  const Point2 point{pose.T_map_base.x_m, pose.T_map_base.y_m};
  const double sigma_m = position_sigma_m(pose.covariance);
  const ZoneId before = zone_;
  if (restart_ || zone_ == kNoZone) {
    const ZoneId start = graph_.zone_near(point, settings_.start_radius_m + 3 * sigma_m);
    if (start != kNoZone) {
      zone_ = start;
      restart_ = false;
    }
    pose_zone_ = zone_;
    return zone_ != before;
  }
  pose_zone_ = zone_;
  if (side_of(graph_.polygon(zone_), point) != Side::kOutside) {
    confirmed_from_ = kNoZone;
    return false;
  }
  const ZoneId other = graph_.zone_at(point);
  if (other == kNoZone) return false;
  pose_zone_ = other;
  if (keeps_confirmed(point, sigma_m)) return false;
  const double depth_m = graph_.depth_m(other, point);
  const bool through_portal =
      portal_leads_to(other, point, depth_m + 3 * sigma_m + kPortalOffBorder_m);
  const double needed_m = through_portal
                              ? std::clamp(sigma_m, settings_.least_depth_m, settings_.most_depth_m)
                              : settings_.wall_depth_m + 3 * sigma_m;
  if (depth_m >= needed_m) zone_ = other;
  return zone_ != before;
}

}  // namespace zonepack
