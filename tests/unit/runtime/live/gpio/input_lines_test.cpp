// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/input_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/sim/sim_gpio.hpp"

namespace zonepack {
namespace {

using testing::HasSubstr;

// Lines 0 dock (active low), 1 hold, 2 a marker.
class InputLinesTest : public testing::Test {
 protected:
  InputLinesTest() {
    chips.add_chip("robot", 8);
    chips.drive("robot", 0, true);
    const auto input = [](const char* line, bool low) {
      return InputLine{.chip = "robot",
                       .line = line,
                       .active_low = low,
                       .bias = GpioBias::kAsIs,
                       .debounce_s = 0};
    };
    gpio.dock.emplace().input = input("0", true);
    gpio.hold = input("1", false);
    gpio.markers.push_back({"door", input("2", false), {{"a", "b"}, 1}});
  }

  InputLines& opened() {
    lines = std::make_unique<InputLines>(chips, gpio, board);
    const auto opened = lines->open(false);
    EXPECT_TRUE(opened) << opened.error().message;
    return *lines;
  }
  void drive(unsigned line, bool high) {
    now_ns += 1'000'000;
    chips.advance_to(now_ns);
    chips.drive("robot", line, high);
  }
  std::vector<LineEdge> taken() {
    lines->turn(now_ns);
    std::vector<LineEdge> all;
    for (LineEdge edge; lines->edges.pop(edge);) all.push_back(edge);
    return all;
  }

  SimGpio chips;
  GpioSettings gpio;
  LineBoard board;
  std::unique_ptr<InputLines> lines;
  std::int64_t now_ns = 1'000'000'000;
};

TEST_F(InputLinesTest, TellWhichLineChangedWhenAndHow) {
  opened();
  EXPECT_TRUE(taken().empty());
  drive(0, false);
  drive(2, true);
  drive(1, true);
  const auto edges = taken();
  ASSERT_EQ(edges.size(), 3u);
  EXPECT_EQ(edges[0].line, LineEdge::kDock);
  EXPECT_TRUE(edges[0].active);
  EXPECT_EQ(edges[0].stamp_ns, 1'001'000'000);
  EXPECT_EQ(edges[1].line, LineEdge::kHold);
  EXPECT_EQ(edges[2].line, LineEdge::kFirstMarker);
  EXPECT_EQ(board.rows()[2].name, "zone_markers.door");
  EXPECT_TRUE(board.rows()[2].active.load());
  EXPECT_EQ(board.rows()[2].changes.load(), 1u);
}

TEST_F(InputLinesTest, TellOfALineThatIsActiveWhenTheRunStarts) {
  chips.drive("robot", 1, true);
  opened();
  const auto edges = taken();
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges[0].line, LineEdge::kHold);
}

TEST_F(InputLinesTest, KeepEdgesAtTheirLineWhileTheQueueIsFull) {
  opened();
  bool high = true;
  std::size_t told = 0;
  for (int i = 0; i < 400; ++i, high = !high) {  // nobody takes them
    drive(1, high);
    lines->turn(now_ns);
  }
  for (LineEdge edge; lines->edges.pop(edge); ++told) EXPECT_EQ(edge.active, told % 2 == 0);
  EXPECT_GT(told, 200u);
  EXPECT_LT(told, 256u);
  LineEdge last{};
  for (auto rest = taken(); !rest.empty(); rest = taken()) last = rest.back();
  EXPECT_FALSE(last.active);  // as the line is
}

TEST_F(InputLinesTest, ALineThatFailsCountsAsInactiveAndComesBack) {
  chips.add_chip("spare", 2);
  gpio.hold->chip = "spare";
  opened();
  chips.drive("spare", 1, true);
  EXPECT_EQ(taken().size(), 1u);
  chips.remove_chip("spare");
  const auto edges = taken();
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_FALSE(edges[0].active);
  EXPECT_FALSE(board.rows()[1].working.load());
  drive(2, true);
  EXPECT_EQ(taken().size(), 1u);  // the others go on
  chips.add_chip("spare", 2);
  EXPECT_TRUE(taken().empty());  // not yet
  now_ns += 1'000'000'000;
  taken();
  EXPECT_TRUE(board.rows()[1].working.load());
}

TEST_F(InputLinesTest, AnOutputIsRefusedAsAnInputByName) {
  chips.make_output("robot", 2);
  InputLines refused(chips, gpio, board);
  const auto opened = refused.open(false);
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message,
              HasSubstr("gpio.zone_markers.door: line 2 of chip robot: set up as an output"));
}

}  // namespace
}  // namespace zonepack
