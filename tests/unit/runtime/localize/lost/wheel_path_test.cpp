// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/wheel_path.hpp"

#include <gtest/gtest.h>

namespace zonepack::localize {
namespace {

TEST(WheelPath, IsStraightBetweenTwoMomentsAndEndsAtTheFirstAndLast) {
  WheelPath path(1000);
  EXPECT_FALSE(path.at(5));
  path.add(100, {1, 0, 0});
  path.add(200, {3, 0, 0.4});
  path.add(200, {9, 9, 0});                  // not later: left out
  EXPECT_DOUBLE_EQ(path.at(125)->x_m, 1.5);  // a quarter of 2 m
  EXPECT_DOUBLE_EQ(path.at(125)->yaw_rad, 0.1);
  EXPECT_DOUBLE_EQ(path.at(50)->x_m, 1);
  EXPECT_DOUBLE_EQ(path.at(900)->x_m, 3);
}

TEST(WheelPath, ForgetsWhatIsOlderThanItKeeps) {
  WheelPath path(100);
  path.add(0, {1, 0, 0});
  path.add(50, {2, 0, 0});
  path.add(150, {3, 0, 0});
  EXPECT_DOUBLE_EQ(path.at(0)->x_m, 2);  // 50 is 100 old, 0 is older
}

}  // namespace
}  // namespace zonepack::localize
