// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/messages/bus_messages.hpp"

#include <gtest/gtest.h>

#include "runtime/live/bus/live_source.hpp"

namespace zonepack {
namespace {

TEST(BusMessages, TellsOnlyChanges) {
  BusMessages messages("can0");
  EXPECT_FALSE(messages.next({}));
  EXPECT_EQ(messages.next({.link = CanLink::kDown}),
            "can0: down; no odometry until it is up again");
  EXPECT_FALSE(messages.next({.link = CanLink::kDown}));
  EXPECT_EQ(messages.next({.link = CanLink::kUp}), "can0: up");
  EXPECT_EQ(messages.next({.dropped = 3}), "can0: 3 frames lost before they were read");
  EXPECT_EQ(messages.next({.dropped = 5}), "can0: 2 frames lost before they were read");
}

TEST(BusMessages, TellsOfABusOffAndTheWayOutOfIt) {
  BusMessages messages("can0");
  const auto off = messages.next({.state = CanBusState::kOff, .bus_offs = 1});
  ASSERT_TRUE(off);
  EXPECT_NE(off->find("restart-ms"), std::string::npos);
  EXPECT_EQ(messages.next({.bus_offs = 1, .restarts = 1}),
            "can0: the controller is error active; restarted after a bus-off");
}

TEST(OdometryIds, NameEachIdOnce) {
  WheelOdometrySettings odometry;
  odometry.signals[0].id = odometry.signals[1].id = 0x311;
  EXPECT_EQ(odometry_ids(odometry), (std::vector<CanId>{{0x311, false}}));
  odometry.signals[1].extended = true;
  EXPECT_EQ(odometry_ids(odometry), (std::vector<CanId>{{0x311, false}, {0x311, true}}));
}

TEST(OdometryIds, NameWhatTellsThatCanOpenDrivesAreAlive) {
  WheelOdometrySettings odometry;
  odometry.signals[0].id = odometry.signals[1].id = 0x181;
  odometry.canopen.nodes = {1, 2};
  odometry.canopen.node_count = 2;
  odometry.canopen.sync_timeout_s = 0.1;
  EXPECT_EQ(odometry_ids(odometry),
            (std::vector<CanId>{{0x181, false}, {0x701, false}, {0x702, false}, {0x80, false}}));
}

}  // namespace
}  // namespace zonepack
