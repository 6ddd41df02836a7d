// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/cycle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "platform/can/can_errors.hpp"
#include "tests/unit/runtime/control/cycle_in_rooms.hpp"

namespace zonepack {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

TEST_F(CycleTest, DoesNothingBeforeAPoseIsKnown) {
  stand(100);
  EXPECT_EQ(cycle.state().zone, kNoZone);
  EXPECT_FALSE(cycle.state().map_ready);
  EXPECT_EQ(memory.charged(), 0u);
  EXPECT_THAT(words(), ElementsAre("start", "odometry_resumed"));
}

TEST_F(CycleTest, LoadsTheZoneOfTheFirstFixAndIsReadyOnceItIsTrusted) {
  step();
  step({fix(2, 2)});
  EXPECT_EQ(cycle.state().zone, 0u);
  EXPECT_EQ(memory.state(0), ZoneState::kFilling);
  stand(20);
  EXPECT_TRUE(cycle.state().zone_resident);
  EXPECT_FALSE(cycle.state().map_ready);
  step({fix(2, 2)});
  EXPECT_TRUE(cycle.state().map_ready);
}

TEST_F(CycleTest, WantsTheZonesOfAllHypothesesUntilOneIsTrusted) {
  step();
  step({fix(2, 2)});
  stand(20);
  step({fix(10, 2)});  // 8 m off: another hypothesis
  stand(40);
  EXPECT_TRUE(memory.resident(0));
  EXPECT_TRUE(memory.resident(2));
  step({fix(10, 2)});
  EXPECT_EQ(cycle.state().zone, 2u);
  EXPECT_TRUE(cycle.state().map_ready);
}

TEST_F(CycleTest, HasTheNextZoneReadyWhenTheRobotEntersIt) {
  trust(2, 2);
  drive(2.5);  // through the door at x = 4
  EXPECT_EQ(cycle.state().zone, 1u);
  EXPECT_TRUE(cycle.state().zone_resident);
  EXPECT_THAT(words(), Not(Contains("not_keeping_up b")));
  EXPECT_EQ(cycle.state().zone_switches, 1u);
  drive(4.0);  // through the door at x = 8: room for two only
  EXPECT_EQ(cycle.state().zone, 2u);
  EXPECT_FALSE(memory.resident(0));
  EXPECT_TRUE(memory.resident(1));
}

TEST_F(CycleTest, WhatALocalizerSeesTakesNoRoomFromWhatItSeesAlready) {
  step();
  step({fix(10, 2)});
  stand(40);
  step({fix(2, 2)});  // another hypothesis
  stand(40);
  PoseCorrection seen = fix(2, 2);  // along the row, through both doors
  seen.view_m = 10;
  step({seen});
  stand(40);
  ASSERT_EQ(cycle.state().zone, 0u);
  EXPECT_THAT(words(), Contains("zone_wanted b"));
  EXPECT_FALSE(memory.resident(1));  // nearer, but its room is that of c
  EXPECT_TRUE(memory.resident(2));
  drive(1.9);  // b is approached
  EXPECT_TRUE(memory.resident(1));
  EXPECT_FALSE(memory.resident(2));
}

TEST_F(CycleTest, FollowsTheFixesAtOnceWhenTheyMoveThePose) {
  trust(2, 2);
  for (int i = 0; i < 3; ++i) {
    step({fix(10, 2)});
    stand(30);
  }
  EXPECT_EQ(cycle.state().zone, 2u);
  EXPECT_THAT(words(), Contains("pose_reinitialised"));
  EXPECT_THAT(words(), Contains("correction_rejected"));
  EXPECT_TRUE(cycle.state().zone_resident);
}

TEST_F(CycleTest, ReportsWhenOdometryIsMissingAndWhenItIsBack) {
  trust(2, 2);
  events.clear();
  for (int i = 0; i < 50; ++i) step({}, false);  // 0.5 s, over the timeout of 0.3 s
  EXPECT_THAT(words(), ElementsAre("odometry_stale"));
  step();
  EXPECT_THAT(words(), ElementsAre("odometry_stale", "odometry_resumed"));
}

TEST_F(CycleTest, ReportsWhenTheControllerLeavesTheBusAndRestarts) {
  trust(2, 2);
  events.clear();
  const auto take = [this](std::vector<CanFrame> frames) {
    now_ns += kPeriod_ns;
    cycle.run({.now_ns = now_ns, .frames = frames});
  };
  // However many a broken bus sends, one cycle reports it once.
  take({error_frame(kCanErrorBusOff), error_frame(kCanErrorBusOff)});
  EXPECT_THAT(words(), ElementsAre("bus_off"));
  take({error_frame(kCanErrorController, kCanControllerPassive)});
  take({error_frame(kCanErrorRestarted)});
  EXPECT_THAT(words(), ElementsAre("bus_off", "bus_restarted"));
}

TEST_F(CycleTest, RefusesAPinThatLeavesNoRoomForAPairAndAZoneThatDoesNotExist) {
  trust(2, 2);
  EXPECT_EQ(ask(command(Command::Kind::kPin, 2)).error.code, ErrorCode::kNoRoom);  // 4 + 8 of 8
  EXPECT_EQ(ask(command(Command::Kind::kPin, 7)).error.code, ErrorCode::kNotFound);
  EXPECT_EQ(cycle.replies().size(), 1u);
  EXPECT_EQ(cycle.replies()[0].id, last_id);
}

TEST_F(CycleTest, LoadsTheNextZonesOfAHintedRouteWhileStanding) {
  trust(2, 2);
  Command hint = command(Command::Kind::kRouteHint);
  hint.route_length = 3;
  hint.route = {0, 1, 2};
  ask(hint);
  stand(30);
  EXPECT_TRUE(memory.resident(1));
  hint.route_length = 0;
  ask(hint);
  stand(2);
  EXPECT_THAT(words(), Contains("zone_unwanted b"));
}

TEST_F(CycleTest, EvictsNothingWhileFrozenAndSaysThatItIsBlocked) {
  trust(2, 2);
  drive(2.5);  // a and b fill the memory
  ask(command(Command::Kind::kFreeze));
  drive(4.0);
  EXPECT_TRUE(memory.resident(0));
  EXPECT_TRUE(cycle.state().blocked);
  ask(command(Command::Kind::kUnfreeze));
  stand(30);
  EXPECT_TRUE(memory.resident(2));
  EXPECT_FALSE(cycle.state().blocked);
}

TEST_F(CycleTest, GrantsALeaseOnAResidentZoneOnly) {
  trust(2, 2);
  const CommandReply granted = ask(command(Command::Kind::kLease, 0));
  EXPECT_EQ(granted.error.code, ErrorCode::kOk);
  EXPECT_EQ(granted.lease.zone, 0u);
  EXPECT_EQ(granted.lease.generation, memory.generation(0));
  EXPECT_EQ(ask(command(Command::Kind::kLease, 2)).error.code, ErrorCode::kNotFound);
}

TEST_F(CycleTest, TakesNoMemoryWhileRunning) {
  trust(2, 2);
  drive(6.5);
  step({fix(2, 2)});  // an outlier
  for (int i = 0; i < 50; ++i) step({}, false);
  EXPECT_GT(memory.counters().zones_unloaded, 0u);
  EXPECT_EQ(allocations, 0u);
}

TEST_F(CycleTest, StampsEventsWithTheTimeSinceTheFirstCycle) {
  trust(2, 2);
  cycle.finish();
  EXPECT_EQ(events.front().t_ns, 0);
  EXPECT_EQ(events.back().kind, EventKind::kEnd);
  EXPECT_EQ(events.back().t_ns, static_cast<std::int64_t>(events.back().cycle) * kPeriod_ns);
  EXPECT_EQ(events.back().x_mm, 2000);
}

TEST_F(CycleTest, TheDocksContactPlacesTheRobotAtOnce) {
  trust(2, 2);
  events.clear();
  edge(LineEdge::kDock, true);
  EXPECT_TRUE(cycle.state().pose.trusted);
  EXPECT_NEAR(cycle.state().pose.T_map_base.x_m, 10, 1e-9);
  EXPECT_EQ(cycle.state().zone, 2u);
  EXPECT_EQ(events[0].kind, EventKind::kDocked);
  EXPECT_EQ(events[0].x_mm, 10000);
  stand(20);
  EXPECT_TRUE(cycle.state().map_ready);
  edge(LineEdge::kDock, false);
  EXPECT_EQ(events.back().kind, EventKind::kUndocked);
  EXPECT_EQ(cycle.state().zone, 2u);
}

// In room a; then lost: nothing is known, what is in memory stays there until room is needed.
TEST_F(CycleTest, TheDockIsEnoughToTrustAnUnknownPose) {
  step();
  edge(LineEdge::kDock, true);
  EXPECT_TRUE(cycle.state().pose.trusted);
  stand(20);
  EXPECT_TRUE(cycle.state().map_ready);
}

TEST_F(CycleTest, AContactFromBeforeTheHistoryMovesNothing) {
  trust(2, 2);
  edge(LineEdge::kDock, true, 60'000'000'000);
  EXPECT_EQ(cycle.state().zone, 0u);
  EXPECT_STREQ(events.back().reason, "too_old");
}

TEST_F(CycleTest, TheHoldLineFreezesEvictionIndependentlyOfTheCommand) {
  trust(2, 2);
  drive(2.5);  // a and b fill the memory
  edge(LineEdge::kHold, true);
  drive(4.0);
  EXPECT_TRUE(memory.resident(0));
  EXPECT_TRUE(cycle.state().blocked);
  ask(command(Command::Kind::kFreeze));
  edge(LineEdge::kHold, false);
  stand(30);
  EXPECT_TRUE(memory.resident(0));  // still frozen by command
  ask(command(Command::Kind::kUnfreeze));
  stand(30);
  EXPECT_TRUE(memory.resident(2));
  EXPECT_THAT(words(), Contains("hold_begun"));
  EXPECT_THAT(words(), Contains("hold_ended"));
}

TEST_F(CycleTest, AMarkerMovesTheRobotThroughItsDoorBeforeThePoseDoes) {
  trust(2, 2);
  drive(1.75);  // at 3.75: a quarter of a metre before the door
  EXPECT_EQ(cycle.state().zone, 0u);
  events.clear();
  left_mm += 10, right_mm += 10;
  edge(LineEdge::kFirstMarker, true);
  EXPECT_EQ(cycle.state().zone, 1u);
  EXPECT_EQ(cycle.state().zone_switches, 1u);
  EXPECT_THAT(words(), Contains("zone_confirmed b"));
  EXPECT_THAT(words(), Contains("zone_entered b"));
  events.clear();
  drive(1.0);
  EXPECT_EQ(cycle.state().zone, 1u);
  EXPECT_EQ(cycle.state().zone_switches, 1u);
  edge(LineEdge::kFirstMarker, false);
  EXPECT_THAT(words(), Not(Contains("zone_entered a")));
}

TEST_F(CycleTest, AMarkerElsewhereIsIgnoredAndSaysWhy) {
  trust(2, 2);
  events.clear();
  edge(LineEdge::kFirstMarker, true);
  EXPECT_THAT(words(), ElementsAre("marker_ignored"));
  EXPECT_STREQ(events[0].reason, "elsewhere");
  edge(LineEdge::kFirstMarker + 9, true);  // no such marker
  EXPECT_EQ(events.size(), 1u);
}

}  // namespace
}  // namespace zonepack
