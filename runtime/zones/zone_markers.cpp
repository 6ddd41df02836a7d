// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/zone_markers.hpp"

#include <algorithm>

#include "runtime/odometry/det_math.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack {
namespace {

constexpr double kStanding_m_s = 0.005;

ZoneId zone_named(const ZoneGraph& graph, const std::string& name) {
  for (ZoneId zone = 0; zone < graph.zone_count(); ++zone) {
    if (graph.name(zone) == name) return zone;
  }
  return kNoZone;
}

bool leads_to(const ZoneGraph& graph, ZoneId from, ZoneId to) {
  const auto exits = graph.exits(from);
  return std::any_of(exits.begin(), exits.end(), [to](const Exit& exit) { return exit.to == to; });
}

// How fast the robot moves along a direction in the map, m/s.
double speed_along(const PoseEstimate& pose, Point2 direction) noexcept {
  const double c = det_cos(pose.T_map_base.yaw_rad), s = det_sin(pose.T_map_base.yaw_rad);
  const double x = c * pose.speed_m_s - s * pose.sideways_m_s;
  const double y = s * pose.speed_m_s + c * pose.sideways_m_s;
  return x * direction.x_m + y * direction.y_m;
}

}  // namespace

ZoneMarkers::ZoneMarkers(const ZoneGraph& graph, std::span<const ZoneMarkerSettings> markers)
    : graph_(graph) {
  for (const ZoneMarkerSettings& marker : markers) {
    markers_.push_back({zone_named(graph, marker.zone), zone_named(graph, marker.other),
                        !marker.other.empty(), marker.reach_m});
  }
}

const Exit* ZoneMarkers::near_exit(ZoneId from, ZoneId to, Point2 point,
                                   double reach_m) const noexcept {
  const auto exits = graph_.exits(from);
  const auto found = std::find_if(exits.begin(), exits.end(), [&](const Exit& exit) {
    return exit.to == to && distance_m(exit.segment, point) <= reach_m;
  });
  return found == exits.end() ? nullptr : &*found;
}

MarkerVerdict ZoneMarkers::pass(std::size_t marker, const PoseEstimate& pose,
                                ZoneId current) const noexcept {
  const Marker& passed = markers_[marker];
  if (passed.zone == kNoZone || (passed.door && passed.other == kNoZone)) {
    return {.refused = "no such zone"};
  }
  if (!pose.valid || current == kNoZone) return {.refused = "no pose"};
  const Point2 point{pose.T_map_base.x_m, pose.T_map_base.y_m};
  const double reach_m = passed.reach_m + 3 * position_sigma_m(pose.covariance);
  if (!passed.door) {
    const bool there =
        current == passed.zone || near_exit(current, passed.zone, point, reach_m) != nullptr;
    return there ? MarkerVerdict{passed.zone} : MarkerVerdict{.refused = "elsewhere"};
  }
  if (current != passed.zone && current != passed.other) return {.refused = "elsewhere"};
  const ZoneId beyond = current == passed.zone ? passed.other : passed.zone;
  const Exit* const exit = near_exit(current, beyond, point, reach_m);
  if (exit == nullptr) return {.refused = "elsewhere"};
  const double outward_m_s = speed_along(pose, exit->outward);
  if (outward_m_s > kStanding_m_s) return {beyond};
  if (outward_m_s < -kStanding_m_s) return {current};
  return {.refused = "standing"};
}

Outcome<void> ZoneMarkers::check(const ZoneGraph& graph,
                                 std::span<const ZoneMarkerSettings> markers) {
  for (const ZoneMarkerSettings& marker : markers) {
    const std::string key = "gpio.zone_markers." + marker.name + ".zones: ";
    const ZoneId zone = zone_named(graph, marker.zone);
    const ZoneId other = zone_named(graph, marker.other);
    if (zone == kNoZone) return failure(key + "the map has no zone " + marker.zone);
    if (marker.other.empty()) continue;
    if (other == kNoZone) return failure(key + "the map has no zone " + marker.other);
    if (!leads_to(graph, zone, other)) {
      return failure(key + "no portal leads from " + marker.zone + " to " + marker.other +
                     "; name two zones that one drives between, or one zone alone");
    }
  }
  return {};
}

}  // namespace zonepack
