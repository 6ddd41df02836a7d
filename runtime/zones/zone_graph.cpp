// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/zone_graph.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

// Probes lie this far from a portal's middle in both zones: past the snap distance of its ends.
constexpr double kProbe_m = 0.25;

Point2 along(Point2 from, Point2 direction, double distance_m) noexcept {
  return {from.x_m + direction.x_m * distance_m, from.y_m + direction.y_m * distance_m};
}

}  // namespace

Point2 ZoneGraph::direction_into(ZoneId zone, const Segment2& portal) const noexcept {
  const double length = distance_m(portal.p, portal.q);
  if (length == 0) return {};
  const Point2 middle{(portal.p.x_m + portal.q.x_m) / 2, (portal.p.y_m + portal.q.y_m) / 2};
  const Point2 across{(portal.p.y_m - portal.q.y_m) / length,
                      (portal.q.x_m - portal.p.x_m) / length};
  const double ahead = depth_m(zone, along(middle, across, kProbe_m));
  const double behind = depth_m(zone, along(middle, across, -kProbe_m));
  return ahead >= behind ? across : Point2{-across.x_m, -across.y_m};
}

ZoneGraph::ZoneGraph(std::vector<GraphZone> zones, std::span<const GraphPortal> portals)
    : zones_(std::move(zones)), first_exit_(zones_.size() + 1, 0), exits_(2 * portals.size()) {
  std::vector<Box2> boxes;
  boxes.reserve(zones_.size());
  for (const GraphZone& zone : zones_) boxes.push_back(bounds(zone.polygon.outer));
  boxes_ = BoxTree(boxes);

  for (const GraphPortal& portal : portals) {
    ZP_REQUIRE(portal.zone_a < zones_.size() && portal.zone_b < zones_.size());
    ++first_exit_[portal.zone_a + 1];
    ++first_exit_[portal.zone_b + 1];
  }
  for (std::size_t i = 1; i < first_exit_.size(); ++i) first_exit_[i] += first_exit_[i - 1];
  std::vector<std::uint32_t> next(first_exit_.begin(), first_exit_.end() - 1);
  for (const GraphPortal& portal : portals) {
    exits_[next[portal.zone_a]++] = {portal.zone_b, portal.segment,
                                     direction_into(portal.zone_b, portal.segment)};
    exits_[next[portal.zone_b]++] = {portal.zone_a, portal.segment,
                                     direction_into(portal.zone_a, portal.segment)};
  }
}

ZoneId ZoneGraph::find(std::string_view name) const noexcept {
  const auto place = std::ranges::lower_bound(
      zones_, name, {}, [](const GraphZone& zone) { return std::string_view(zone.name); });
  if (place == zones_.end() || place->name != name) return kNoZone;
  return static_cast<ZoneId>(place - zones_.begin());
}

std::span<const Exit> ZoneGraph::exits(ZoneId zone) const noexcept {
  return {exits_.data() + first_exit_[zone], exits_.data() + first_exit_[zone + 1]};
}

ZoneId ZoneGraph::zone_of_exit(std::uint32_t number) const noexcept {
  const auto after = std::ranges::upper_bound(first_exit_, number);
  return static_cast<ZoneId>(after - first_exit_.begin() - 1);
}

ZoneId ZoneGraph::zone_at(Point2 point) const noexcept {
  ZoneId inside = kNoZone;
  ZoneId border = kNoZone;
  boxes_.visit_near(point, kBorderTolerance_m, [&](ZoneId zone) {
    const Side side = side_of(zones_[zone].polygon, point);
    if (side == Side::kInside && zone < inside) inside = zone;
    if (side == Side::kBorder && zone < border) border = zone;
  });
  return inside != kNoZone ? inside : border;
}

ZoneId ZoneGraph::zone_near(Point2 point, double radius_m) const noexcept {
  const ZoneId holding = zone_at(point);
  if (holding != kNoZone) return holding;
  ZoneId nearest = kNoZone;
  double least_m = radius_m;
  boxes_.visit_near(point, radius_m, [&](ZoneId zone) {
    const double distance = distance_to_border_m(zones_[zone].polygon, point);
    if (distance < least_m || (distance == least_m && zone < nearest)) {
      nearest = zone;
      least_m = distance;
    }
  });
  return nearest;
}

double ZoneGraph::depth_m(ZoneId zone, Point2 point) const noexcept {
  const Polygon& polygon = zones_[zone].polygon;
  const double distance = distance_to_border_m(polygon, point);
  return side_of(polygon, point) == Side::kOutside ? -distance : distance;
}

ByteCount ZoneGraph::memory_bytes() const noexcept {
  ByteCount bytes = zones_.capacity() * sizeof(GraphZone) +
                    first_exit_.capacity() * sizeof(std::uint32_t) +
                    exits_.capacity() * sizeof(Exit) + boxes_.memory_bytes();
  for (const GraphZone& zone : zones_) {
    bytes += zone.name.size() + 1;
    bytes += zone.polygon.outer.capacity() * sizeof(Point2);
    bytes += zone.polygon.holes.capacity() * sizeof(Ring);
    for (const Ring& hole : zone.polygon.holes) bytes += hole.capacity() * sizeof(Point2);
  }
  return bytes;
}

}  // namespace zonepack
