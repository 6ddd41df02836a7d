// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/zones_in_view.hpp"

#include <algorithm>
#include <utility>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

constexpr double kHalfAngle_rad = 40 * kPi / 180;
// A portal may lie this far off the borders that it joins.
constexpr double kSlack_m = 0.1;

// The part of the way from `from` to `to` at which it leaves through the exit; 2: it does not.
double leaves_at(const Exit& exit, Point2 from, Point2 to) noexcept {
  const double along = dot(to - from, exit.outward);
  if (along <= 0) return 2;
  const double part = dot(exit.segment.p - from, exit.outward) / along;
  if (part > 1) return 2;
  const Point2 meet{from.x_m + (to.x_m - from.x_m) * part, from.y_m + (to.y_m - from.y_m) * part};
  const Point2 span = exit.segment.q - exit.segment.p;
  const double place = dot(meet - exit.segment.p, span), length2 = dot(span, span);
  return place >= 0 && place <= length2 ? part : 2;
}

}  // namespace

ZonesInView::ZonesInView(const ZoneGraph& graph, const Pose2& T_map_base, ZoneId zone,
                         double view_m) noexcept {
  if (zone == kNoZone) return;
  const Point2 from{T_map_base.x_m, T_map_base.y_m};
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle =
        wrap_angle(T_map_base.yaw_rad + kHalfAngle_rad * (2.0 * ray / (kRays - 1) - 1));
    const Point2 to{from.x_m + view_m * det_cos(angle), from.y_m + view_m * det_sin(angle)};
    follow_ray(graph, from, to, zone, view_m);
  }
  const auto end = static_cast<std::size_t>(
      std::remove(zones_.begin(), zones_.begin() + static_cast<std::ptrdiff_t>(count_), zone) -
      zones_.begin());
  count_ = end;
}

void ZonesInView::follow_ray(const ZoneGraph& graph, Point2 from, Point2 to, ZoneId zone,
                             double view_m) noexcept {
  double reached = 0;
  for (int hop = 0; hop < kMostHops; ++hop) {
    const Exit* first = nullptr;
    double least = 2;
    for (const Exit& exit : graph.exits(zone)) {
      const double part = leaves_at(exit, from, to);
      if (part < reached - kSlack_m / view_m || part >= least) continue;
      least = part;
      first = &exit;
    }
    if (first == nullptr) return;
    reached = std::max(reached, least);
    zone = first->to;
    see(zone, reached * view_m);
  }
}

// Keeps the list sorted.
void ZonesInView::see(ZoneId zone, double way_m) noexcept {
  std::size_t place = 0;
  while (place < count_ && zones_[place] != zone) ++place;
  if (place < count_) {
    if (ways_m_[place] <= way_m) return;
  } else if (count_ < kMost) {
    ++count_;
  } else if (ways_m_[--place] <= way_m) {
    return;
  }
  zones_[place] = zone;
  ways_m_[place] = way_m;
  const auto sooner = [&](std::size_t a, std::size_t b) {
    return ways_m_[a] != ways_m_[b] ? ways_m_[a] < ways_m_[b] : zones_[a] < zones_[b];
  };
  for (; place > 0 && sooner(place, place - 1); --place) {
    std::swap(zones_[place], zones_[place - 1]);
    std::swap(ways_m_[place], ways_m_[place - 1]);
  }
}

}  // namespace zonepack
