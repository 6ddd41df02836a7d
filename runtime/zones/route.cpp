// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/route.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

// A portal passed when leaving a zone: the zone, and the index among its exits.
using Passage = std::uint64_t;
constexpr Passage kNoPassage = std::numeric_limits<Passage>::max();
// How far a portal may lie off its zones' borders.
constexpr double kOffBorder_m = 1;

Passage passage_of(ZoneId zone, std::size_t exit) noexcept {
  return Passage{zone} << 32 | static_cast<std::uint32_t>(exit);
}

struct Reached {
  double length_m = 0;
  Passage before = kNoPassage;
  bool settled = false;
};

struct Open {
  double at_least_m;
  double length_m;
  Passage passage;
  bool operator>(const Open& other) const noexcept {
    return std::tie(at_least_m, length_m, passage) >
           std::tie(other.at_least_m, other.length_m, other.passage);
  }
};

class Planner {
 public:
  Planner(const ZoneGraph& graph, ZoneId to)
      : graph_(graph), to_(to), goal_(bounds(graph.polygon(to).outer)) {}

  Result<Route> plan(ZoneId from, std::optional<Point2> start) {
    leave(from, start, 0, kNoPassage);
    while (!open_.empty()) {
      const Open best = open_.top();
      open_.pop();
      Reached& reached = reached_[best.passage];
      if (reached.settled) continue;
      reached.settled = true;
      if (exit_of(best.passage).to == to_) return way_to(best.passage, best.length_m);
      if (reached_.size() > kMostRoutePortals) {
        return {ErrorCode::kTooLarge, static_cast<std::int64_t>(reached_.size())};
      }
      const Exit& exit = exit_of(best.passage);
      leave(exit.to, middle(exit), best.length_m, best.passage);
    }
    return ErrorCode::kNotFound;
  }

 private:
  const Exit& exit_of(Passage passage) const noexcept {
    return graph_.exits(static_cast<ZoneId>(passage >> 32))[passage & 0xFFFFFFFF];
  }

  static Point2 middle(const Exit& exit) noexcept {
    return {(exit.segment.p.x_m + exit.segment.q.x_m) / 2,
            (exit.segment.p.y_m + exit.segment.q.y_m) / 2};
  }

  double least_to_go_m(Point2 from) const noexcept {
    const double dx = std::max({goal_.min.x_m - from.x_m, from.x_m - goal_.max.x_m, 0.0});
    const double dy = std::max({goal_.min.y_m - from.y_m, from.y_m - goal_.max.y_m, 0.0});
    return std::max(std::sqrt(dx * dx + dy * dy) - kOffBorder_m, 0.0);
  }

  void leave(ZoneId zone, std::optional<Point2> at, double length_m, Passage before) {
    const std::span<const Exit> exits = graph_.exits(zone);
    for (std::size_t i = 0; i < exits.size(); ++i) {
      const Point2 door = middle(exits[i]);
      const double through_m = length_m + (at ? distance_m(*at, door) : 0);
      const Passage passage = passage_of(zone, i);
      const auto [entry, is_new] = reached_.try_emplace(passage);
      if (entry->second.settled || (!is_new && entry->second.length_m <= through_m)) continue;
      entry->second = {through_m, before, false};
      open_.push({through_m + least_to_go_m(door), through_m, passage});
    }
  }

  Route way_to(Passage last, double length_m) const {
    Route route;
    route.length_m = length_m;
    route.zones.push_back(to_);
    for (Passage passage = last; passage != kNoPassage; passage = reached_.at(passage).before) {
      route.doors.push_back(middle(exit_of(passage)));
      route.zones.push_back(static_cast<ZoneId>(passage >> 32));
    }
    std::reverse(route.zones.begin(), route.zones.end());
    std::reverse(route.doors.begin(), route.doors.end());
    return route;
  }

  const ZoneGraph& graph_;
  const ZoneId to_;
  const Box2 goal_;
  std::unordered_map<Passage, Reached> reached_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace

Result<Route> plan_route(const ZoneGraph& graph, ZoneId from, ZoneId to,
                         std::optional<Point2> start) {
  ZP_REQUIRE(from < graph.zone_count() && to < graph.zone_count());
  if (from == to) return Route{{from}, {}, 0};
  return Planner(graph, to).plan(from, start);
}

}  // namespace zonepack
