// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/text_plan.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace zonepack {
namespace {

using Look = TextPlan::Look;

// Two rooms of 8 m by 8 m next to each other, A to the west.
TextPlan two_rooms(bool utf8 = false) {
  return TextPlan({{{0, 0}, {8, 0}, {8, 8}, {0, 8}}, {{8, 0}, {16, 0}, {16, 8}, {8, 8}}}, utf8);
}
std::vector<TextPlan::Shade> shades(Look a, Look b) {
  return {{.name = "A", .look = a}, {.name = "B", .look = b}};
}

std::vector<std::string> text_of(const std::vector<ScreenLine>& lines) {
  std::vector<std::string> text;
  for (const ScreenLine& line : lines) text.push_back(line.done());
  return text;
}

TEST(TextPlan, DrawsZonesByTheirState) {
  // 16 columns of 1 m, and 4 rows of 2 m: A takes columns 0 to 7, B 8 to 15, of which column 8 is
  // the wall. Names are in the middle of the longest run, in the second row.
  const auto lines =
      text_of(two_rooms().draw({16, 4}, shades(Look::kOwn, Look::kAbsent), std::nullopt, false));
  EXPECT_EQ(lines, (std::vector<std::string>{"@@@@@@@@|.......\n", "@@@@A@@@|...B...\n",
                                             "@@@@@@@@|.......\n", "@@@@@@@@|.......\n"}));
}

TEST(TextPlan, PointsAnArrowWhereTheRobotGoes) {
  // (2.5, 6.5): column 2, row 0. 1.6 rad: north.
  const auto lines = text_of(two_rooms().draw({16, 4}, shades(Look::kResident, Look::kWanted),
                                              TextPlan::Robot{2.5, 6.5, 1.6}, false));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0], "##^#####|???????\n");
  const auto south_east = text_of(two_rooms(true).draw(
      {16, 4}, shades(Look::kAbsent, Look::kAbsent), TextPlan::Robot{15.5, 0.5, -0.7}, false));
  EXPECT_TRUE(south_east[3].ends_with("↘\n")) << south_east[3];
}

TEST(TextPlan, SaysHowWideItIs) {
  // 16 m by 8 m in 4 rows of 2 m: 1 m a column.
  EXPECT_EQ(two_rooms().columns_in(4), 16);
  EXPECT_EQ(two_rooms().columns_in(8), 32);
}

TEST(TextPlan, KeepsToTheSizeAndLeavesOutARobotElsewhere) {
  for (const int columns : {1, 7, 16, 200}) {
    for (const int rows : {1, 3, 50}) {
      const auto lines =
          text_of(two_rooms().draw({columns, rows}, shades(Look::kFilling, Look::kFilling),
                                   TextPlan::Robot{1e9, -1e9, 0}, false));
      EXPECT_LE(lines.size(), static_cast<std::size_t>(rows));
      for (const std::string& line : lines) {
        EXPECT_LE(line.size(), static_cast<std::size_t>(columns) + 1);
        EXPECT_EQ(line.find('>'), std::string::npos);
      }
    }
  }
}

TEST(TextPlan, IsEmptyWithoutGround) {
  EXPECT_TRUE(TextPlan().empty());
  EXPECT_TRUE(TextPlan({{}, {}}, false).empty());
  EXPECT_TRUE(TextPlan({{{1, 1}, {1, 1}}}, false).empty());
}

TEST(TextPlan, UsesNoColorWhereItIsNotWanted) {
  setenv("TERM", "xterm", 1);
  setenv("NO_COLOR", "1", 1);
  EXPECT_FALSE(terminal_shows_color());
  setenv("NO_COLOR", "", 1);  // empty counts as absent
  EXPECT_TRUE(terminal_shows_color());
  setenv("TERM", "dumb", 1);
  EXPECT_FALSE(terminal_shows_color());
}

}  // namespace
}  // namespace zonepack
