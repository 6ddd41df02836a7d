// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/zone_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace zonepack::localize {

Point2 middle_of(const Ring& outline) noexcept {
  Point2 sum{};
  for (const Point2& point : outline) {
    sum.x_m += point.x_m;
    sum.y_m += point.y_m;
  }
  const double count = std::max<double>(1, static_cast<double>(outline.size()));
  return {sum.x_m / count, sum.y_m / count};
}

std::vector<SearchZone> search_zones(const Catalog& map) {
  std::vector<SearchZone> zones;
  for (const CatalogZone& zone : map.zones) {
    zones.push_back({zone.signatures, middle_of(zone.polygon.outer), {}});
  }
  for (const CatalogPortal& portal : map.portals) {
    if (portal.zone_a >= zones.size() || portal.zone_b >= zones.size()) continue;
    zones[portal.zone_a].doors.push_back(portal.zone_b);
    zones[portal.zone_b].doors.push_back(portal.zone_a);
  }
  return zones;
}

std::vector<ZoneId> search_order(std::span<const SearchZone> zones, ZoneId last) {
  const auto count = static_cast<ZoneId>(zones.size());
  if (count == 0) return {};
  if (last >= count) {
    last = 0;
    for (ZoneId zone = 1; zone < count; ++zone) {
      if (zones[zone].signatures > zones[last].signatures) last = zone;
    }
  }
  constexpr std::size_t kFar = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> doors(count, kFar);  // from the first zone
  std::vector<ZoneId> reached{last};
  doors[last] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const ZoneId to : zones[reached[i]].doors) {
      if (to >= count || doors[to] != kFar) continue;
      doors[to] = doors[reached[i]] + 1;
      reached.push_back(to);
    }
  }
  const Point2 start = zones[last].middle;
  std::vector<double> away(count);
  std::vector<ZoneId> order(count);
  for (ZoneId zone = 0; zone < count; ++zone) {
    const Point2 middle = zones[zone].middle;
    away[zone] = zone == last ? -1 : std::hypot(middle.x_m - start.x_m, middle.y_m - start.y_m);
    order[zone] = zone;
  }
  std::stable_sort(order.begin(), order.end(), [&](ZoneId a, ZoneId b) {
    return std::pair(doors[a], away[a]) < std::pair(doors[b], away[b]);
  });
  return order;
}

}  // namespace zonepack::localize
