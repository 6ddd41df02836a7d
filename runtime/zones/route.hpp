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

// Portals examined before planning gives up: bounds its time, and its memory to about 1 MiB.
inline constexpr std::size_t kMostRoutePortals = std::size_t{16} * 1024;

// The shortest route between two zones, straight from the middle of one portal to the middle of the
// next (A*, whose heuristic is the distance to the goal's box). No zone needs to be in memory.
// Begins at `start`, which lies in `from`; without it, leaving `from` costs nothing. The same
// result on every machine: of two equally long routes, the one through the lower ZoneIds.
// kNotFound: there is no route; kTooLarge: over kMostRoutePortals. Allocates; not for the control
// thread.
Result<Route> plan_route(const ZoneGraph& graph, ZoneId from, ZoneId to,
                         std::optional<Point2> start = std::nullopt);

}  // namespace zonepack
