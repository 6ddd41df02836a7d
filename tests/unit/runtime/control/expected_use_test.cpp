// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/expected_use.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// A corridor (zone 5, x 0 to 20) with rooms 0 to 4 above it, 4 m wide each; all of one slot.
constexpr ZoneId kRooms = 5, kCorridor = 5;
constexpr std::uint64_t kSlots = 3;

ZoneGraph ward() {
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  for (ZoneId room = 0; room < kRooms; ++room) {
    const double x = 4.0 * room;
    zones.push_back({"r" + std::to_string(room), box(x, 4, x + 4, 8)});
    portals.push_back({room, kCorridor, {{x + 1, 4}, {x + 3, 4}}});
  }
  zones.push_back({"s", box(0, 0, 20, 4)});
  return ZoneGraph(std::move(zones), portals);
}

class ExpectedUseTest : public testing::Test {
 protected:
  const ZoneGraph graph = ward();
  const std::vector<ZoneNeed> needs{kRooms + 1, ZoneNeed{1, 1}};
  Transitions transitions{graph};
  ExpectedUse order{{needs, kSlots, &transitions}};
  std::vector<ZoneLink> links{needs.size()};
  std::vector<ZoneTimes> times{needs.size()};
  ZoneList held{links};
  std::vector<bool> resident = std::vector<bool>(kRooms + 1);
  ZoneId before = kNoZone, now = kNoZone;
  int loads = 0;

  EvictionCandidates candidates() const { return {held, times, needs[0], 16384}; }

  // Enters a zone; what it evicts for it, or kNoZone.
  ZoneId enter(ZoneId zone, std::span<const ZoneId> ahead = {}) {
    before = now;
    now = zone;
    ZoneId evicted = kNoZone;
    order.begin_cycle({0, now, before, ahead});
    order.requested(zone, resident[zone]);
    if (resident[zone]) {
      held.remove(zone, needs[zone]);
    } else {
      if (held.sum().slots == kSlots) {
        evicted = order.choose(candidates());
        held.remove(evicted, needs[evicted]);
        resident[evicted] = false;
      }
      ++loads;
      resident[zone] = true;
      order.loaded(zone, needs[zone]);
    }
    held.append(zone, needs[zone]);
    return evicted;
  }
  void learn(std::initializer_list<ZoneId> rooms, int rounds) {
    ZoneId last = kNoZone;
    for (int i = 0; i < rounds; ++i) {
      for (const ZoneId room : rooms) {
        if (last != kNoZone) {
          transitions.learn(kCorridor, last, kCorridor, kSecond_ns);
          transitions.learn(last, kCorridor, room, kSecond_ns);
        }
        last = room;
      }
    }
  }
};

TEST_F(ExpectedUseTest, WithARouteTheZoneUsedFarthestAheadGoes) {
  const ZoneId way[] = {0, kCorridor, 1, kCorridor, 2, kCorridor, 0, kCorridor, 1};
  const auto ahead = [&](std::size_t done) { return std::span(way).subspan(done); };
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(enter(way[i], ahead(i + 1)), kNoZone);
  // For room 2 goes room 1, used last, and not room 0, which was used longer ago.
  EXPECT_EQ(enter(2, ahead(5)), 1U);
}

TEST_F(ExpectedUseTest, AHabitKeepsWhatIsComingBack) {
  learn({0, 1, 0, 2}, 20);
  for (const ZoneId zone : {0U, kCorridor, 1U, kCorridor}) enter(zone);
  enter(0);
  enter(kCorridor);
  // Next are 2 and then 0: so room 1 goes, although 0 is no warmer in the order of a fresh start.
  EXPECT_EQ(enter(2), 1U);
}

TEST_F(ExpectedUseTest, OfZonesOutOfSightTheLeastRecentlyUsedGoes) {
  order.begin_cycle({0, kNoZone, kNoZone, {}});
  for (const ZoneId zone : {3U, 1U, 2U}) held.append(zone, needs[zone]);
  EXPECT_EQ(order.choose(candidates()), 3U);
}

// Three slots; the habit is 0 and 1 with rare visits elsewhere, then the robot goes 2, 3, 2, 3 …,
// for which least recently used loads each once. Lost at most are .2 + .5 of three slots (2), and
// one.
TEST_F(ExpectedUseTest, AWrongForecastCostsABoundedNumberOfLoads) {
  learn({0, 1}, 40);
  for (const ZoneId zone : {0U, kCorridor, 1U, kCorridor}) enter(zone);
  const int learned = loads;
  for (int i = 0; i < 50; ++i) {
    for (const ZoneId zone : {2U, kCorridor, 3U, kCorridor}) enter(zone);
  }
  EXPECT_LE(loads - learned, 2 + 3);
}

}  // namespace
}  // namespace zonepack
