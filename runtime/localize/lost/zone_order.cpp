// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/zone_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace zonepack::localize {
namespace {

Point2 middle_of(const Polygon& polygon) {
  Point2 sum{};
  for (const Point2& point : polygon.outer) {
    sum.x_m += point.x_m;
    sum.y_m += point.y_m;
  }
  const double count = std::max<double>(1, static_cast<double>(polygon.outer.size()));
  return {sum.x_m / count, sum.y_m / count};
}

}  // namespace

std::vector<ZoneId> search_order(const Catalog& map, ZoneId last) {
  const auto count = static_cast<ZoneId>(map.zones.size());
  if (count == 0) return {};
  if (last >= count) {
    last = 0;
    for (ZoneId zone = 1; zone < count; ++zone) {
      if (map.zones[zone].signatures > map.zones[last].signatures) last = zone;
    }
  }
  constexpr std::size_t kFar = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> doors(count, kFar);  // from the first zone
  std::vector<ZoneId> reached{last};
  doors[last] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const CatalogPortal& portal : map.portals) {
      const auto step = [&](ZoneId from, ZoneId to) {
        if (from != reached[i] || to >= count || doors[to] != kFar) return;
        doors[to] = doors[from] + 1;
        reached.push_back(to);
      };
      const ZoneId here = reached[i];
      if (portal.zone_a == here) step(here, portal.zone_b);
      if (portal.zone_b == here) step(here, portal.zone_a);
    }
  }
  const Point2 start = middle_of(map.zones[last].polygon);
  std::vector<double> away(count);
  std::vector<ZoneId> order(count);
  for (ZoneId zone = 0; zone < count; ++zone) {
    const Point2 middle = middle_of(map.zones[zone].polygon);
    away[zone] = std::hypot(middle.x_m - start.x_m, middle.y_m - start.y_m);
    order[zone] = zone;
  }
  std::stable_sort(order.begin(), order.end(), [&](ZoneId a, ZoneId b) {
    return std::pair(doors[a], away[a]) < std::pair(doors[b], away[b]);
  });
  return order;
}

}  // namespace zonepack::localize
