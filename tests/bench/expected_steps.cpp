// SPDX-License-Identifier: Apache-2.0
// Chooses what to evict by expected use COUNT times, each after a new forecast, in a map of SIDE
// times SIDE square zones, each joined to its four neighbours, of which HELD are candidates; inside
// measured(): for counting its instructions, which must not depend on SIDE, nor on HELD from 64 on.
//
//   valgrind --tool=callgrind --toggle-collect='measured(*)' expected_steps SIDE HELD COUNT
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "runtime/control/expected_use.hpp"

using namespace zonepack;

namespace {

ZoneGraph grid(ZoneId side) {
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  for (ZoneId row = 0; row < side; ++row) {
    for (ZoneId column = 0; column < side; ++column) {
      const double x = 4.0 * column, y = 4.0 * row;
      const ZoneId zone = row * side + column;
      zones.push_back(
          {std::to_string(zone), {{{x, y}, {x + 4, y}, {x + 4, y + 4}, {x, y + 4}}, {}}});
      if (column + 1 < side) portals.push_back({zone, zone + 1, {{x + 4, y + 1}, {x + 4, y + 3}}});
      if (row + 1 < side) portals.push_back({zone, zone + side, {{x + 1, y + 4}, {x + 3, y + 4}}});
    }
  }
  return ZoneGraph(std::move(zones), portals);
}

}  // namespace

[[gnu::noinline]] ZoneId measured(ExpectedUse& order, const EvictionMoment& moment,
                                  const EvictionCandidates& candidates) {
  order.begin_cycle(moment);
  return order.choose(candidates);
}

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: expected_steps SIDE HELD COUNT\n");
    return 2;
  }
  const auto side = static_cast<ZoneId>(std::strtoul(argv[1], nullptr, 10));
  const auto held = static_cast<ZoneId>(std::strtoul(argv[2], nullptr, 10));
  const unsigned long count = std::strtoul(argv[3], nullptr, 10);
  if (side < 30 || held >= side * side) return 2;
  const ZoneGraph graph = grid(side);
  const std::vector<ZoneNeed> needs(graph.zone_count(), ZoneNeed{1, 1});
  const Transitions transitions(graph);
  ExpectedUse order({needs, held, &transitions});
  std::vector<ZoneLink> links(needs.size());
  const std::vector<ZoneTimes> times(needs.size());
  ZoneList list(links);
  for (ZoneId zone = 0; zone < held; ++zone) list.append(zone, needs[zone]);
  const ZoneId middle = side / 2 * side + side / 2;
  for (unsigned long i = 0; i < count; ++i) {
    // Entered from the left and from the right in turn.
    const EvictionMoment moment{0, middle, i % 2 == 0 ? middle - 1 : middle + 1, {}};
    if (measured(order, moment, {list, times, needs[0], 1}) == kNoZone) std::abort();
  }
  return 0;
}
