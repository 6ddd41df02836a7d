// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/output_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "platform/process/clock.hpp"
#include "platform/sim/sim_gpio.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kMilli_ns = 1'000'000;

// Lines 0 map_ready, 1 fault (active low), 2 heartbeat.
class OutputLinesTest : public testing::Test {
 protected:
  OutputLinesTest() {
    chips.add_chip("robot", 4);
    gpio.map_ready = OutputLine{.chip = "robot", .line = "0"};
    gpio.fault = OutputLine{.chip = "robot", .line = "1", .active_low = true};
    gpio.heartbeat = OutputLine{.chip = "robot", .line = "2"};
    status.state.odometry_stale = false;
    status.state.pose.trusted = true;
    status.state.zone = 3;
  }

  OutputLines& opened() {
    lines = std::make_unique<OutputLines>(chips, gpio, board);
    lines->set_period(10 * kMilli_ns);
    const auto opened = lines->open(false);
    EXPECT_TRUE(opened) << opened.error().message;
    return *lines;
  }
  // A control cycle, and what the thread does after it.
  void cycle(bool ready) {
    ++status.state.cycles;
    status.state.map_ready = status.state.zone_resident = ready;
    turn();
  }
  void turn() {
    now_ns += 10 * kMilli_ns;
    lines->turn(status, load, now_ns);
  }
  bool map_ready() const { return chips.is_high("robot", 0); }
  bool in_fault() const { return !chips.is_high("robot", 1); }
  std::uint64_t beats() const { return chips.changes("robot", 2); }

  SimGpio chips;
  GpioSettings gpio;
  LineBoard board;
  std::unique_ptr<OutputLines> lines;
  LiveStatus status;
  LoadEnd load;
  std::int64_t now_ns = 1'000'000'000;
};

TEST_F(OutputLinesTest, AreAtTheirSafeLevelsUntilTheFirstCycle) {
  opened();
  EXPECT_FALSE(map_ready());
  EXPECT_TRUE(in_fault());
  turn();
  EXPECT_TRUE(in_fault());
  EXPECT_EQ(beats(), 0u);
}

TEST_F(OutputLinesTest, FollowTheRobotsZoneAndWhatIsWrong) {
  opened();
  cycle(false);
  EXPECT_FALSE(map_ready());
  EXPECT_TRUE(in_fault());  // trusted, and its zone not in memory
  cycle(true);
  EXPECT_TRUE(map_ready());
  EXPECT_FALSE(in_fault());
  status.state.blocked = true;
  cycle(true);
  EXPECT_TRUE(in_fault());
  status.state.blocked = false;
  status.state.odometry_stale = true;
  cycle(true);
  EXPECT_TRUE(in_fault());
  EXPECT_TRUE(map_ready());
}

TEST_F(OutputLinesTest, TheHeartbeatTogglesOnlyAsCyclesGoOn) {
  opened();
  for (int i = 0; i < 100; ++i) cycle(true);  // a second; half a wave is 50 ms
  EXPECT_EQ(beats(), 20u);
  for (int i = 0; i < 100; ++i) turn();
  EXPECT_LE(beats(), 21u);  // the cycle before the stand may have one left
}

TEST_F(OutputLinesTest, WhenCyclesStandMapReadyFallsAndFaultRises) {
  opened();
  for (int i = 0; i < 10; ++i) cycle(true);
  for (int i = 0; i < 10; ++i) turn();  // 100 ms
  EXPECT_TRUE(map_ready());
  turn();
  EXPECT_FALSE(map_ready());
  EXPECT_TRUE(in_fault());
  cycle(true);
  EXPECT_TRUE(map_ready());
  EXPECT_FALSE(in_fault());
}

TEST_F(OutputLinesTest, WriteALineOnlyWhenItChanges) {
  opened();
  for (int i = 0; i < 50; ++i) cycle(true);
  EXPECT_EQ(chips.changes("robot", 0), 1u);
  EXPECT_EQ(chips.changes("robot", 1), 1u);
  EXPECT_EQ(board.rows()[0].changes.load(), 1u);
}

TEST_F(OutputLinesTest, AreSafeAgainWhenStoppedAndStayThere) {
  opened();
  cycle(true);
  EXPECT_TRUE(map_ready());
  lines->make_safe();
  EXPECT_FALSE(map_ready());
  EXPECT_TRUE(in_fault());
  cycle(true);
  EXPECT_FALSE(map_ready());
  gpio.map_ready->safe = SafeLevel::kActive;
  gpio.fault->safe = SafeLevel::kInactive;
  lines.reset();
  EXPECT_FALSE(map_ready());
  opened();
  EXPECT_TRUE(map_ready());
  EXPECT_FALSE(in_fault());
}

TEST_F(OutputLinesTest, ALineThatFailsStopsTheHeartbeatAndIsTriedAgain) {
  chips.add_chip("far", 1);
  gpio.map_ready = OutputLine{.chip = "far", .line = "0"};
  opened();
  for (int i = 0; i < 20; ++i) cycle(true);
  const std::uint64_t before = beats();
  EXPECT_GT(before, 0u);
  chips.remove_chip("far");
  for (int i = 0; i < 20; ++i) cycle(i == 19);
  EXPECT_EQ(beats(), before);
  EXPECT_FALSE(board.rows()[0].working.load());
  EXPECT_GE(board.rows()[0].failures.load(), 1u);
  EXPECT_FALSE(in_fault());  // the others go on
}

TEST_F(OutputLinesTest, AMissingOrBusyLineIsRefusedByNameOrLeftOut) {
  gpio.map_ready->line = "9";
  chips.occupy("robot", 1, "somebody");
  OutputLines strict(chips, gpio, board);
  const auto refused = strict.open(false);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("gpio.map_ready: line 9 of chip robot: the chip has no such line"));
  EXPECT_THAT(refused.error().message, HasSubstr("--allow-degraded"));
  LineBoard other;
  OutputLines lenient(chips, gpio, other);
  const auto opened = lenient.open(true);
  ASSERT_TRUE(opened);
  EXPECT_THAT(*opened, ElementsAre(HasSubstr("gpio.map_ready"),
                                   HasSubstr("gpio.fault: line 1 of chip robot: held by "
                                             "somebody")));
  EXPECT_FALSE(other.rows()[1].working.load());
  chips.release("robot", 1);
  lenient.set_period(10 * kMilli_ns);
  status.state.cycles = 1;
  lenient.turn(status, load, now_ns);
  EXPECT_TRUE(other.rows()[1].working.load());
}

TEST_F(OutputLinesTest, MeasureFromALoadThatMapReadyWaitedForToItsLine) {
  opened();
  status.state.pose.trusted = false;
  cycle(false);
  load = {3, now_ns + kMilli_ns};
  status.state.pose.trusted = true;
  cycle(true);  // it was trust that it waited for
  EXPECT_EQ(lines->ready_latency().count(), 0u);
  cycle(false);
  load = {5, now_ns + kMilli_ns};  // another zone
  cycle(true);
  EXPECT_EQ(lines->ready_latency().count(), 0u);
  cycle(false);
  load = {3, now_ns + kMilli_ns};
  cycle(true);
  EXPECT_EQ(lines->ready_latency().count(), 1u);
  EXPECT_EQ(board.ready_latency.load().count, 1u);
}

TEST_F(OutputLinesTest, MapReadyRisesOnlyAfterTheFaultThatIsOver) {
  chips.add_chip("slow", 1);
  gpio.fault = OutputLine{.chip = "slow", .line = "0", .active_low = true};
  opened();
  cycle(false);
  chips.hang("slow", true);
  std::thread clears([this] { cycle(true); });
  while (chips.hanging() == 0) std::this_thread::yield();
  EXPECT_FALSE(map_ready());
  chips.hang("slow", false);
  clears.join();
  EXPECT_TRUE(map_ready());
}

// A chip behind a bus that hangs: the thread waits in it, while the control thread's cycles, the
// status that it leaves and everything else go on.
TEST_F(OutputLinesTest, ALineThatHangsDelaysNobodyElse) {
  Seqlock<LiveStatus> left;
  opened();
  ASSERT_TRUE(
      lines->start({[&left] { return left.load(); }, [] { return LoadEnd{}; }}, kMilli_ns).ok());
  chips.hang("robot", true);
  status.state.map_ready = true;
  const auto leave = [&] {
    ++status.state.cycles;
    left.store(status);
  };
  while (chips.hanging() == 0) leave();
  const std::uint64_t hung_at = status.state.cycles;
  for (int i = 0; i < 100'000; ++i) leave();
  EXPECT_EQ(chips.hanging(), 1);
  EXPECT_EQ(status.state.cycles, hung_at + 100'000);
  EXPECT_FALSE(map_ready());
  chips.hang("robot", false);
  while (!map_ready()) leave();
  lines->stop();
  EXPECT_FALSE(map_ready());
}

}  // namespace
}  // namespace zonepack
