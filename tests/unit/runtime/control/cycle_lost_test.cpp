// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/control/cycle.hpp"
#include "tests/unit/runtime/control/cycle_in_rooms.hpp"

namespace zonepack {
namespace {

using testing::Contains;
using testing::ElementsAre;

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

}  // namespace
}  // namespace zonepack
