// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/cycle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "platform/can_errors.hpp"
#include "runtime/run/modelled_loader.hpp"
#include "tests/support/allocation_count/allocation_count.hpp"
#include "tests/support/rooms.hpp"
#include "tests/support/sample_catalog.hpp"

namespace zonepack {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

constexpr std::int64_t kPeriod_ns = 10'000'000;

// Three rooms a, b, c in a row (rooms.hpp), 4 slots each, room for two; a load takes 0.1 s.
class CycleTest : public testing::Test, public EventSink {
 protected:
  CycleTest() { events.reserve(4096); }

  void on_event(const Event& event) noexcept override { events.push_back(event); }

  // One cycle, with a frame that says how far the wheels have come.
  void step(std::vector<PoseCorrection> fixes = {}, bool with_frame = true) {
    now_ns += kPeriod_ns;
    loader.advance_to(now_ns);
    CanFrame frame;
    frame.stamp_ns = now_ns;
    frame.id = 0x311;
    frame.len = 8;
    put(frame, 0, left_mm);
    put(frame, 4, right_mm);
    const testing_support::AllocationCount allocated;
    std::array<LoadResult, 4> loads;
    std::size_t load_count = 0;
    while (const auto load = loader.poll()) loads[load_count++] = *load;
    cycle.run({now_ns,
               {&frame, with_frame ? 1u : 0u},
               fixes,
               {loads.data(), load_count},
               std::exchange(commands, {}),
               {},
               std::exchange(edges, {})});
    allocations += allocated.count();
  }

  void drive(double metres, double metres_per_cycle = 0.01) {
    for (double done = 0; done < metres; done += metres_per_cycle) {
      left_mm += static_cast<std::int32_t>(metres_per_cycle * 1000);
      right_mm += static_cast<std::int32_t>(metres_per_cycle * 1000);
      step();
    }
  }

  void stand(int cycles) {
    for (int i = 0; i < cycles; ++i) step();
  }

  PoseCorrection fix(double x_m, double y_m, double yaw_rad = 0) const {
    return {.stamp_ns = now_ns,
            .received_ns = now_ns,
            .T_map_base = {x_m, y_m, yaw_rad},
            .sigma_x_m = 0.03,
            .sigma_y_m = 0.03,
            .sigma_yaw_rad = 0.01};
  }

  // The fixes of one second apart that make a pose trusted.
  void trust(double x_m, double y_m) {
    step();
    step({fix(x_m, y_m)});
    stand(20);
    step({fix(x_m, y_m)});
    stand(20);
    ASSERT_TRUE(cycle.state().pose.trusted);
  }

  std::vector<std::string> words() const {
    std::vector<std::string> all;
    for (const Event& event : events) {
      std::string word = to_string(event.kind);
      if (event.zone != kNoZone) word += " " + graph.name(event.zone);
      all.push_back(word);
    }
    return all;
  }

  static void put(CanFrame& frame, std::size_t at, std::int32_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < 4; ++i) {
      frame.data[at + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
    }
  }

  const ZoneGraph graph = testing_support::three_rooms();
  const std::vector<ZoneNeed> needs =
      std::vector<ZoneNeed>(3, ZoneNeed{.slots = 4, .signatures = 10});
  const std::vector<LoadWork> work = std::vector<LoadWork>(3, LoadWork{.stored_bytes = 100});
  const std::vector<float> load_s = std::vector<float>(3, 0.12f);
  Residency memory{3,
                   {.budget = 800,
                    .slot_bytes = 100,
                    .largest_pair = {.slots = 8, .signatures = 20},
                    .lease_ns = 1'000'000'000}};
  ModelledLoader loader{8, work, {.storage = 1000, .decode = 1000}, nullptr};
  static CycleConfig robot() {
    CycleConfig config = testing_support::sample_robot();
    config.dock = CycleConfig::Dock{.T_map_base = {10, 2, 0}, .sigma_m = 0.02, .sigma_rad = 0.02};
    config.markers = {{.name = "door", .zone = "a", .other = "b", .reach_m = 0.5}};
    return config;
  }
  Cycle cycle{robot(),
              {.graph = graph,
               .needs = needs,
               .load_s = load_s,
               .pinned = {},
               .memory = memory,
               .loader = loader,
               .events = *this}};
  Command command(Command::Kind kind, ZoneId zone = kNoZone) {
    Command made;
    made.kind = kind;
    made.id = ++last_id;
    made.zone = zone;
    return made;
  }

  // The reply to one command, taken by the next cycle.
  CommandReply ask(const Command& question) {
    commands = {question};
    step();
    return cycle.replies()[0];
  }

  // One cycle that takes a line's change from age_ns ago.
  void edge(std::uint32_t line, bool active, std::int64_t age_ns = 0) {
    edges = {{.stamp_ns = now_ns + kPeriod_ns - age_ns, .line = line, .active = active}};
    step();
  }

  std::vector<Command> commands;
  std::vector<LineEdge> edges;
  std::uint64_t last_id = 0;
  std::vector<Event> events;
  std::size_t allocations = 0;
  std::int64_t now_ns = 1'000'000'000;
  std::int32_t left_mm = 5000, right_mm = 5000;
};

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
TEST_F(CycleTest, ALostPoseIsGivenUpUntilTwoFixesAgree) {
  trust(2, 2);
  ASSERT_TRUE(cycle.state().map_ready);
  events.clear();
  commands = {command(Command::Kind::kLost)};
  step();
  EXPECT_TRUE(cycle.state().lost);
  EXPECT_FALSE(cycle.state().pose.valid);
  EXPECT_FALSE(cycle.state().map_ready);
  EXPECT_EQ(cycle.state().zone, kNoZone);
  EXPECT_THAT(words(), ElementsAre("pose_lost", "zone_entered", "zone_unwanted a"));
  EXPECT_EQ(events[0].x_mm, 2000);  // the pose that is given up
  events.clear();
  commands = {command(Command::Kind::kLost)};
  step();
  EXPECT_TRUE(events.empty());

  step({fix(10, 2)});
  EXPECT_TRUE(cycle.state().lost);
  step({fix(10, 2)});
  EXPECT_FALSE(cycle.state().lost);
  EXPECT_TRUE(cycle.state().pose.trusted);
  EXPECT_THAT(words(), Contains("pose_found"));
  EXPECT_EQ(cycle.state().zone, 2u);
  stand(20);
  EXPECT_TRUE(cycle.state().map_ready);
  EXPECT_EQ(cycle.state().zone_switches, 0u);
}

// Room for two of three rooms: the one sought first makes way.
TEST_F(CycleTest, ALostRobotHasOneZoneAfterTheOtherInMemory) {
  step();
  commands = {command(Command::Kind::kSeek, 0)};
  step();
  EXPECT_EQ(cycle.replies()[0].error.code, ErrorCode::kCancelled);  // it is not lost
  commands = {command(Command::Kind::kLost)};
  step();
  events.clear();
  for (const ZoneId zone : {0u, 1u, 2u}) {
    commands = {command(Command::Kind::kSeek, zone)};
    step();
    EXPECT_EQ(cycle.replies()[0].error.code, ErrorCode::kOk);
    stand(20);
    EXPECT_TRUE(memory.resident(zone));
    EXPECT_FALSE(cycle.state().map_ready);
  }
  EXPECT_FALSE(memory.resident(0));
  EXPECT_TRUE(memory.resident(1));
  EXPECT_THAT(words(), Contains("zone_sought c"));
  commands = {command(Command::Kind::kSeek, 3)};
  step();
  EXPECT_EQ(cycle.replies()[0].error.code, ErrorCode::kNotFound);
  commands = {command(Command::Kind::kAskTurn)};
  step();
  EXPECT_EQ(events.back().kind, EventKind::kTurnAsked);
}

// Leases hold the rooms a and b: c does not fit, and waits.
TEST_F(CycleTest, ASoughtZoneTakesNoRoomFromLeases) {
  trust(2, 2);
  commands = {command(Command::Kind::kLease, 0)};
  step();
  ASSERT_EQ(cycle.replies()[0].error.code, ErrorCode::kOk);
  commands = {command(Command::Kind::kLost)};
  step();
  commands = {command(Command::Kind::kSeek, 1)};
  step();
  stand(20);
  ASSERT_TRUE(memory.resident(1));
  ASSERT_TRUE(memory.lease(1, now_ns));
  commands = {command(Command::Kind::kSeek, 2)};
  step();
  stand(20);
  EXPECT_TRUE(memory.resident(0));
  EXPECT_TRUE(memory.resident(1));
  EXPECT_FALSE(memory.resident(2));
  EXPECT_TRUE(cycle.state().blocked);
}

// 1 m ahead, in steps of 1 cm.
TEST_F(CycleTest, SaysHowFarTheWheelsCameWithoutAnyPose) {
  step();
  drive(1);
  EXPECT_FALSE(cycle.state().pose.valid);
  EXPECT_NEAR(cycle.state().T_wheels_base.x_m, 1, 0.011);
  EXPECT_NEAR(cycle.state().T_wheels_base.y_m, 0, 1e-9);
}

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
