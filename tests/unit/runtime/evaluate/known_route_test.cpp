// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/known_route.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

Event entered(ZoneId zone, std::int64_t t_ns) {
  Event event;
  event.kind = EventKind::kZoneEntered;
  event.zone = zone;
  event.t_ns = t_ns;
  return event;
}

class KnownRoute : public testing::Test {
 protected:
  ZonesEntered zones;
  // on_event() asks nothing of the map.
  void enter(ZoneId zone, std::int64_t t_ns) { zones.note(entered(zone, t_ns)); }
};

TEST_F(KnownRoute, IsHintedFromTheStartOn) {
  enter(3, 5);
  enter(1, 20);
  const auto hints = hints_of(zones, 1000);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints[0].received_ns, 1000);
  EXPECT_EQ(hints[0].command.kind, Command::Kind::kRouteHint);
  ASSERT_EQ(hints[0].command.route_length, 2u);
  EXPECT_EQ(hints[0].command.route[0], 3u);
  EXPECT_EQ(hints[0].command.route[1], 1u);
}

// 64 zones to a hint, the next hint after 32: of 100 zones the hints begin at 0, 32, 64 and 96.
TEST_F(KnownRoute, IsHintedAgainBeforeAHintEnds) {
  for (ZoneId zone = 0; zone < 100; ++zone) enter(zone, zone * 10);
  const auto hints = hints_of(zones, 0);
  ASSERT_EQ(hints.size(), 4u);
  EXPECT_EQ(hints[1].received_ns, 320);
  EXPECT_EQ(hints[1].command.route[0], 32u);
  EXPECT_EQ(hints[1].command.route_length, 64u);
  EXPECT_EQ(hints[3].command.route_length, 4u);
}

TEST_F(KnownRoute, LeavesOutWhereTheRobotIsInNoZone) {
  enter(3, 5);
  enter(kNoZone, 10);
  enter(3, 15);
  EXPECT_EQ(hints_of(zones, 0)[0].command.route_length, 2u);
}

TEST_F(KnownRoute, OfNoZonesIsNoHint) { EXPECT_TRUE(hints_of(zones, 0).empty()); }

}  // namespace
}  // namespace zonepack
