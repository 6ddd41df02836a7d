// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/canopen_watch.hpp"

#include <gtest/gtest.h>

#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kWatchMs = 1'000'000;

CanFrame frame(std::int64_t t_ms, std::uint32_t id, std::initializer_list<int> bytes = {}) {
  CanFrame made;
  made.stamp_ns = t_ms * kWatchMs;
  made.id = id;
  for (const int byte : bytes) made.data[made.len++] = static_cast<std::uint8_t>(byte);
  return made;
}

CanOpenWatchSettings two_nodes() {
  CanOpenWatchSettings settings;
  settings.nodes = {1, 2};
  settings.node_count = 2;
  settings.heartbeat_timeout_s = 0.3;
  return settings;
}

TEST(CanOpenWatch, IsHealthyWhenNothingIsWatched) {
  CanOpenWatch watch({});
  EXPECT_TRUE(watch.healthy());
  EXPECT_FALSE(watch.take(frame(0, 0x701, {0})));
  EXPECT_TRUE(watch.healthy());
}

TEST(CanOpenWatch, WantsEveryNodeOperationalAndHeardInTime) {
  CanOpenWatch watch(two_nodes());
  EXPECT_FALSE(watch.healthy());
  watch.take(frame(0, 0x701, {5}));
  EXPECT_FALSE(watch.healthy());
  watch.take(frame(10, 0x702, {127}));  // pre-operational
  EXPECT_FALSE(watch.healthy());
  watch.take(frame(20, 0x702, {5}));
  EXPECT_TRUE(watch.healthy());
  // Node 1 was heard at 0, so at 300 ms it is still alive, at 301 ms not.
  watch.take(frame(300, 0x181));
  EXPECT_TRUE(watch.healthy());
  watch.take(frame(301, 0x181));
  EXPECT_FALSE(watch.healthy());
  EXPECT_EQ(watch.counters().heartbeats_lost, 1u);
  watch.take(frame(310, 0x701, {0x85}));  // the toggle bit of node guarding does not count
  EXPECT_TRUE(watch.healthy());
  watch.take(frame(315, 0x702, {4}));  // stopped
  EXPECT_FALSE(watch.healthy());
  EXPECT_EQ(watch.counters().not_operational, 1u);
}

TEST(CanOpenWatch, ReportsNodesThatRestart) {
  CanOpenWatch watch(two_nodes());
  EXPECT_FALSE(watch.take(frame(0, 0x701, {0})));  // the first start is not a restart
  watch.take(frame(10, 0x701, {5}));
  EXPECT_TRUE(watch.take(frame(50, 0x701, {0})));
  EXPECT_EQ(watch.counters().boots, 1u);
}

TEST(CanOpenWatch, IgnoresOtherFramesOfThatNumber) {
  CanOpenWatch watch(two_nodes());
  watch.take(frame(0, 0x702, {5}));
  CanFrame other = frame(0, 0x701, {5});
  other.extended = true;
  watch.take(other);
  other.extended = false;
  other.rtr = true;
  watch.take(other);
  watch.take(frame(0, 0x701));  // no state
  EXPECT_FALSE(watch.healthy());
  watch.take(frame(0, 0x701, {5}));
  EXPECT_TRUE(watch.healthy());
}

TEST(CanOpenWatch, WantsSyncInTimeToo) {
  CanOpenWatchSettings settings;
  settings.sync_timeout_s = 0.1;
  CanOpenWatch watch(settings);
  EXPECT_FALSE(watch.healthy());
  watch.take(frame(0, 0x80));
  EXPECT_TRUE(watch.healthy());
  watch.take(frame(101, 0x181));
  EXPECT_FALSE(watch.healthy());
  EXPECT_EQ(watch.counters().sync_lost, 1u);
  watch.take(frame(110, 0x80, {7}));  // with a counter
  EXPECT_TRUE(watch.healthy());
}

// Two drives, their positions in millimetres as int32 in 0x181 and 0x182.
struct Drives {
  Drives() {
    WheelOdometrySettings settings;
    for (std::size_t i = 0; i < 2; ++i) {
      settings.signals[i].id = static_cast<std::uint32_t>(0x181 + i);
      settings.signals[i].bits = {0, 32, ByteOrder::kLittle};
      settings.signals[i].type = SignalType::kSigned;
      settings.signals[i].factor = 0.001;
    }
    settings.canopen = two_nodes();
    odometry.emplace(settings);
  }
  void heartbeat(std::int64_t t_ms, int state = 5) {
    odometry->take(frame(t_ms, 0x701, {state}));
    odometry->take(frame(t_ms, 0x702, {state}));
  }
  std::optional<OdometryIncrement> at(std::int64_t t_ms, int mm) {
    odometry->take(frame(t_ms, 0x181, {mm & 255, mm >> 8, 0, 0}));
    return odometry->take(frame(t_ms, 0x182, {mm & 255, mm >> 8, 0, 0}));
  }
  std::optional<WheelOdometry> odometry;
};

TEST(CanOpenOdometry, GoesStaleWhenAHeartbeatIsLostAndBridgesThePauseAfterwards) {
  Drives drives;
  EXPECT_FALSE(drives.at(0, 0));  // no node has been heard yet
  EXPECT_EQ(drives.odometry->counters().unwatched, 2u);
  drives.heartbeat(5);
  drives.at(10, 0);
  EXPECT_TRUE(drives.at(30, 20));
  EXPECT_FALSE(drives.odometry->stale(200 * kWatchMs));
  // Frames go on, heartbeats do not: from 306 ms on they are refused.
  EXPECT_TRUE(drives.at(300, 290));
  EXPECT_FALSE(drives.at(320, 310));
  EXPECT_FALSE(drives.at(640, 630));
  EXPECT_TRUE(drives.odometry->stale(640 * kWatchMs));
  EXPECT_EQ(drives.odometry->counters().canopen.heartbeats_lost, 2u);
  drives.heartbeat(650);
  const auto step = drives.at(660, 650);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->from_ns, 300 * kWatchMs);
  EXPECT_NEAR(step->motion.pose.x_m, 0.36, 1e-12);
}

TEST(CanOpenOdometry, ANodeThatStartsAnewBeginsItsCounterAgainWithoutAJumpOfThePose) {
  Drives drives;
  drives.heartbeat(0);
  for (int t = 0; t <= 100; t += 20) drives.at(t, 40 + t);
  // Counters restart at 0: 140 mm back, which would pass for motion at this rate of frames.
  drives.heartbeat(200, 0);
  drives.heartbeat(205);
  EXPECT_FALSE(drives.at(210, 0));
  const auto step = drives.at(230, 10);
  ASSERT_TRUE(step);
  EXPECT_GT(step->motion.pose.x_m, 0);
  EXPECT_GT(step->motion.covariance.xx, 0.002);  // 0.5 m/s for 110 ms: sigma 0.055 m
  EXPECT_EQ(drives.odometry->counters().rebased, 1u);
  const auto next = drives.at(250, 20);
  ASSERT_TRUE(next);
  EXPECT_NEAR(next->motion.pose.x_m, 0.01, 1e-12);
}

}  // namespace
}  // namespace zonepack
