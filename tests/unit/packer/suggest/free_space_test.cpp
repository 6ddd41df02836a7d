// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/free_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "tests/unit/packer/suggest/drawn_space.hpp"

namespace zonepack::packer::suggest {
namespace {

TEST(SquaredClearance, IsTheSquareOfTheDistanceToTheNearestWall) {
  const FreeSpace space = drawn_space({"#######",  //
                                       "#.....#",  //
                                       "#.....#",  //
                                       "#.....#",  //
                                       "###...#",  //
                                       "#######"});
  const auto clearance2 = squared_clearance(space);
  EXPECT_EQ(clearance2[static_cast<std::size_t>(space.at(0, 0))], 0);
  EXPECT_EQ(clearance2[static_cast<std::size_t>(space.at(1, 4))], 1);
  // (3, 3): two cells to the upper wall, and the corner (2, 1) is 1 across and 2 down.
  EXPECT_EQ(clearance2[static_cast<std::size_t>(space.at(3, 3))], 4);
  // (3, 2): the corner (2, 1) is diagonally next to it.
  EXPECT_EQ(clearance2[static_cast<std::size_t>(space.at(3, 2))], 2);
}

TEST(SquaredClearance, AgreesWithEveryWallTriedInTurn) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    FreeSpace space;
    space.columns = 3 + static_cast<std::int32_t>(random() % 30);
    space.rows = 3 + static_cast<std::int32_t>(random() % 30);
    space.free.assign(static_cast<std::size_t>(space.columns * space.rows), 0);
    for (std::int32_t y = 1; y + 1 < space.rows; ++y) {
      for (std::int32_t x = 1; x + 1 < space.columns; ++x) {
        space.free[static_cast<std::size_t>(space.at(x, y))] = random() % 12 != 0;
      }
    }
    const auto clearance2 = squared_clearance(space);
    for (std::int32_t y = 0; y < space.rows; ++y) {
      for (std::int32_t x = 0; x < space.columns; ++x) {
        std::int32_t nearest = INT32_MAX;
        for (std::int32_t v = 0; v < space.rows; ++v) {
          for (std::int32_t u = 0; u < space.columns; ++u) {
            if (space.is_free(space.at(u, v))) continue;
            nearest = std::min(nearest, (x - u) * (x - u) + (y - v) * (y - v));
          }
        }
        ASSERT_EQ(clearance2[static_cast<std::size_t>(space.at(x, y))], nearest);
      }
    }
  }
}

TEST(RemoveClutter, FreesATableAndKeepsAWallBetweenTwoDoors) {
  // Cells of 0.5 m. The table has 4 cells, 1 m2; the wall has 6 in a row, 3 m long: 1.5 m2, but 0.5
  // m2 a metre is too thick for a wall at this size, so it is drawn finer: 0.1 m a cell below.
  FreeSpace room = drawn_space({"########",  //
                                "#......#",  //
                                "#..##..#",  //
                                "#..##..#",  //
                                "#......#",  //
                                "########"});
  remove_clutter(room, 1.01);
  EXPECT_EQ(std::count(room.free.begin(), room.free.end(), 1), 24);

  // 12 cells of 0.1 m in a row: 1.2 m long, 0.12 m2, so 0.1 m thick: a wall.
  FreeSpace doors = drawn_space({"##################",  //
                                 "#................#",  //
                                 "#..############..#",  //
                                 "#................#",  //
                                 "##################"},
                                0.1);
  remove_clutter(doors, 1.0);
  EXPECT_EQ(std::count(doors.free.begin(), doors.free.end(), 1), 36);
}

// Free but for `boxes`, each from (x0, y0) to (x1, y1) in cells of 5 cm.
FreeSpace room_with(const std::vector<std::array<std::int32_t, 4>>& boxes) {
  FreeSpace room{80, 80, 0.05, std::vector<std::uint8_t>(80 * 80, 1)};
  for (const auto& [x0, y0, x1, y1] : boxes) {
    for (std::int32_t y = y0; y < y1; ++y) {
      for (std::int32_t x = x0; x < x1; ++x) room.free[static_cast<std::size_t>(room.at(x, y))] = 0;
    }
  }
  return room;
}

TEST(RemoveClutter, KeepsThickWallsThatMeetInACornerOrACross) {
  // 0.3 m thick. The corner has 36 x 6 + 18 x 6 cells, 0.81 m2, 2.16 m from end to end: 0.37 m2 a
  // metre, as thick as a shelf. The cross has 36 x 6 + 30 x 6 cells, 0.99 m2: 0.39 m2 a metre.
  for (FreeSpace room : {room_with({{20, 20, 56, 26}, {20, 26, 26, 44}}),
                         room_with({{20, 35, 56, 41}, {35, 20, 41, 56}})}) {
    const std::vector<std::uint8_t> before = room.free;
    remove_clutter(room, 2.5);
    EXPECT_EQ(room.free, before);
  }
}

TEST(RemoveClutter, FreesABedAndAShelfThatStandFree) {
  FreeSpace room = room_with({{10, 10, 28, 50}, {40, 10, 48, 60}});  // 0.9 x 2 m, 0.4 x 2.5 m
  remove_clutter(room, 2.5);
  EXPECT_EQ(room.free, room_with({}).free);
}

TEST(RemoveClutter, KeepsWhatIsAsLargeAsTheLimit) {
  FreeSpace room = drawn_space({"#####", "#...#", "#.#.#", "#...#", "#####"});
  remove_clutter(room, 0.25);  // the pillar has 0.25 m2
  EXPECT_FALSE(room.is_free(room.at(2, 2)));
  remove_clutter(room, 0.26);
  EXPECT_TRUE(room.is_free(room.at(2, 2)));
}

}  // namespace
}  // namespace zonepack::packer::suggest
