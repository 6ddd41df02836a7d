// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/fix_consistency.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace zonepack {
namespace {

TEST(FixConsistency, LeavesHonestFixesAsTheyAre) {
  FixConsistency consistency;
  for (int i = 0; i < 1000; ++i) consistency.add(i % 2 == 0 ? 1 : 5);
  EXPECT_EQ(consistency.widening(), 1);
}

// 3 + (60 - 3) / 32 after one; 60 / (3 * 2) after many.
TEST(FixConsistency, WidensThoseThatClaimTooMuchWithinBounds) {
  FixConsistency consistency;
  consistency.add(1e9);
  EXPECT_DOUBLE_EQ(consistency.mean(), 4.78125);
  for (int i = 0; i < 1000; ++i) consistency.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NEAR(consistency.widening(), 10, 1e-9);
  UncertainPose fix;
  fix.covariance = {1, 2, 3, 4, 5, 6};
  EXPECT_NEAR(consistency.widened(fix).covariance.y_yaw, 50, 1e-7);
}

TEST(FixConsistency, ForgivesWithTime) {
  FixConsistency consistency;
  for (int i = 0; i < 100; ++i) consistency.add(60);
  EXPECT_GT(consistency.widening(), 9);
  for (int i = 0; i < 200; ++i) consistency.add(3);
  EXPECT_EQ(consistency.widening(), 1);
}

}  // namespace
}  // namespace zonepack
