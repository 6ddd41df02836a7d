// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// A way through the building: zones in order, and the middle of the portal between each and the
// next. Metres in the map frame.
struct Route {
  std::vector<ZoneId> zones;
  std::vector<Point2> doors;  // one fewer than zones
  double length_m = 0;        // from the start, or else the first door, to the last door
};

// Portals looked at before a plan is given up: what bounds its time, and its memory to about 1 MiB.
inline constexpr std::size_t kMostRoutePortals = std::size_t{16} * 1024;

// The shortest way from zone to zone, straight from the middle of one portal to that of the next
// (A*, with the distance to the goal's box as what is still to go). Needs no zone to be in memory.
// From `start`, which lies in `from`; without it, leaving `from` costs nothing. The same result on
// every machine: of two equal ways, the one through the lower ZoneIds. kNotFound: no way leads
// there; kTooLarge: over kMostRoutePortals. Allocates; not for the control thread.
Result<Route> plan_route(const ZoneGraph& graph, ZoneId from, ZoneId to,
                         std::optional<Point2> start = std::nullopt);

}  // namespace zonepack
