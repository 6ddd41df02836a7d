// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/odometry_history.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace zonepack {
namespace {

UncertainPose ahead(double metres) {
  UncertainPose step{{metres, 0, 0}, {}};
  step.covariance.xx = metres * 1e-4;
  return step;
}

TEST(OdometryHistory, FindsTheFirstEntryAtOrAfterAStamp) {
  OdometryHistory history(8);
  EXPECT_EQ(history.find(0), std::nullopt);
  history.restart(100);
  const std::uint64_t first = history.newest();
  history.push(120, ahead(1));
  history.push(140, ahead(1));
  EXPECT_EQ(history.find(99), std::nullopt);
  EXPECT_EQ(history.find(100), first);
  EXPECT_EQ(history.find(101), first + 1);
  EXPECT_EQ(history.find(120), first + 1);
  EXPECT_EQ(history.find(140), first + 2);
  EXPECT_EQ(history.find(141), std::nullopt);
}

TEST(OdometryHistory, DropsTheOldestWhenFull) {
  OdometryHistory history(3);
  history.restart(0);
  for (int i = 1; i <= 5; ++i) history.push(i * 10, ahead(1));
  EXPECT_EQ(history.newest() - history.oldest(), 2u);
  EXPECT_EQ(history.at(history.oldest()).t_ns, 30);
  EXPECT_EQ(history.find(29), std::nullopt);
  EXPECT_DOUBLE_EQ(history.back().state.pose.x_m, 5);
}

TEST(OdometryHistory, NumbersGoOnAfterARestart) {
  OdometryHistory history(3);
  history.restart(0);
  const std::uint64_t before = history.newest();
  history.push(10, ahead(1));
  history.restart(5);
  EXPECT_GT(history.oldest(), before + 1);
  EXPECT_EQ(history.oldest(), history.newest());
  EXPECT_EQ(history.back().t_ns, 5);
}

TEST(OdometryHistory, CarriesAPoseFromTheMiddleOfAStep) {
  OdometryHistory history(4);
  history.restart(0);
  history.push(10, {along_arc(1, 0.5), {}});
  const UncertainPose quarter{{0, 0, 0}, {}};
  // A quarter of the step is behind: three quarters are left.
  const UncertainPose carried = history.carry_to_entry(quarter, 5, history.newest());
  EXPECT_NEAR(carried.pose.yaw_rad, 0.25, 1e-12);
  const Pose2 rest = along_arc(0.5, 0.25);
  EXPECT_NEAR(carried.pose.x_m, rest.x_m, 1e-12);
  EXPECT_NEAR(carried.pose.y_m, rest.y_m, 1e-12);
  EXPECT_EQ(history.carry_to_entry(quarter, 10, history.newest()).pose, quarter.pose);
}

TEST(OdometryHistory, CutsAStepInTwo) {
  OdometryHistory history(8);
  history.restart(0);
  history.push(10, ahead(1));
  history.push(20, ahead(4)).drift = true;
  history.back().has_fix = true;
  history.push(30, ahead(1));
  const std::uint64_t cut = *history.find(12);
  const UncertainPose end = history.back().state;
  history.split(cut, 12);
  EXPECT_EQ(history.at(cut).t_ns, 12);
  EXPECT_NEAR(history.at(cut).step.pose.x_m, 0.8, 1e-12);
  EXPECT_NEAR(history.at(cut).state.pose.x_m, 1.8, 1e-12);
  EXPECT_FALSE(history.at(cut).has_fix);
  EXPECT_EQ(history.at(cut + 1).t_ns, 20);
  EXPECT_NEAR(history.at(cut + 1).step.pose.x_m, 3.2, 1e-12);
  EXPECT_TRUE(history.at(cut + 1).has_fix && history.at(cut + 1).drift);
  EXPECT_EQ(history.newest(), cut + 2);
  EXPECT_EQ(history.back().t_ns, 30);
  EXPECT_EQ(history.back().state.pose, end.pose);
}

TEST(OdometryHistory, SpreadsTheMotionOfAPauseOverItsEntries) {
  OdometryHistory history(8);
  history.restart(0);
  history.push(10, ahead(1));
  history.push(20, {}).drift = true;
  history.push(30, {}).drift = true;
  // 3 m from 10 to 40: a metre for each entry, and one more for the rest.
  const std::uint64_t before = history.fill_drift(10, 40, ahead(3));
  EXPECT_EQ(history.at(before).t_ns, 10);
  history.replay_from(before);
  EXPECT_EQ(history.back().t_ns, 40);
  for (std::uint64_t i = history.oldest() + 1; i <= history.newest(); ++i) {
    EXPECT_NEAR(history.at(i).step.pose.x_m, 1, 1e-12);
    EXPECT_NEAR(history.at(i).step.covariance.xx, 1e-4, 1e-12);
    EXPECT_FALSE(history.at(i).drift);
  }
  EXPECT_NEAR(history.back().state.pose.x_m, 4, 1e-12);
}

TEST(OdometryHistory, TheWholeMotionCountsWhenTheStartOfAPauseWasDropped) {
  OdometryHistory history(3);
  history.restart(0);
  for (int t = 10; t <= 50; t += 10) history.push(t, {}).drift = true;
  const double before = history.back().state.pose.x_m;
  history.replay_from(history.fill_drift(0, 60, ahead(6)));
  EXPECT_NEAR(history.at(history.oldest()).step.pose.x_m + history.back().step.pose.x_m, 4, 1e-12);
  EXPECT_NEAR(history.back().state.pose.x_m - before, 6 * 2 / 3.0, 1e-12);
}

TEST(OdometryHistory, ReplaysStepsAndFixes) {
  OdometryHistory history(8);
  history.restart(0);
  for (int i = 1; i <= 3; ++i) history.push(i * 10, ahead(1));
  OdometryHistory::Entry& second = history.at(history.oldest() + 2);
  second.fix = {{10, 0, 0}, {}};
  second.fix.covariance.xx = second.fix.covariance.yy = second.fix.covariance.yaw_yaw = 1e-6;
  second.has_fix = true;
  UncertainPose& start = history.at(history.oldest()).state;
  start.pose = {5, 0, 0};
  start.covariance.xx = start.covariance.yy = start.covariance.yaw_yaw = 1;
  history.replay_from(history.oldest());
  // 5 + 1 + 1 = 7, drawn to 10 by the certain fix, + 1.
  EXPECT_NEAR(history.back().state.pose.x_m, 11, 1e-4);
}

}  // namespace
}  // namespace zonepack
