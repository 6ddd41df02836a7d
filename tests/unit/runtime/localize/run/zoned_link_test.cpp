// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/zoned_link.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace zonepack::localize {
namespace {

constexpr std::int64_t kLinkSecond_ns = 1'000'000'000;

// The run's clock is 1000 s behind CLOCK_REALTIME, which is 900 s ahead of CLOCK_MONOTONIC: an
// image at 5 s of CLOCK_MONOTONIC is at 905 s of CLOCK_REALTIME, and at -95 s of the run.
TEST(OnRunClock, TakesEachClock) {
  RobotState state;
  state.offset_ns = 1000 * kLinkSecond_ns;
  const std::int64_t offset_ns = 900 * kLinkSecond_ns;
  EXPECT_EQ(on_run_clock(5 * kLinkSecond_ns, ImageClock::kMonotonic, state, offset_ns),
            -95 * kLinkSecond_ns);
  EXPECT_EQ(on_run_clock(905 * kLinkSecond_ns, ImageClock::kRealtime, state, offset_ns),
            -95 * kLinkSecond_ns);
  EXPECT_EQ(on_run_clock(7, ImageClock::kRun, state, offset_ns), 7);
}

RobotState driving() {
  RobotState state;
  state.has_pose = true;
  state.pose_ns = 10 * kLinkSecond_ns;
  state.pose.T_map_base = {1, 2, std::numbers::pi / 2};
  state.pose.covariance.xx = state.pose.covariance.yy = 0.01;
  state.pose.covariance.yaw_yaw = 0.001;
  state.speed_m_s = 1;
  return state;
}

// 0.2 s earlier at 1 m/s along y: 0.2 m back. Sigma 0.02 m of it: 0.01 + 0.0004.
TEST(PoseAt, GoesBackToTheImage) {
  const QueryPrior prior = pose_at(driving(), 9'800'000'000);
  EXPECT_NEAR(prior.T_map_base.x_m, 1, 1e-12);
  EXPECT_NEAR(prior.T_map_base.y_m, 1.8, 1e-12);
  EXPECT_NEAR(prior.covariance.xx, 0.0104, 1e-12);
}

// 0.1 s at 1 rad/s: 0.1 rad farther, past pi from 3.1: 3.2 - 2 pi. Sigma 0.01: 0.001 + 0.0001.
TEST(PoseAt, TurnsAndWraps) {
  RobotState state = driving();
  state.speed_m_s = 0;
  state.yaw_rate_rad_s = 1;
  state.pose.T_map_base.yaw_rad = 3.1;
  const QueryPrior prior = pose_at(state, 10'100'000'000);
  EXPECT_NEAR(prior.T_map_base.yaw_rad, 3.2 - 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(prior.covariance.yaw_yaw, 0.0011, 1e-12);
}

// The last speed says nothing about a minute: half a second of it counts.
TEST(PoseAt, GoesNoFartherThanHalfASecond) {
  EXPECT_NEAR(pose_at(driving(), 70 * kLinkSecond_ns).T_map_base.y_m, 2.5, 1e-12);
}

}  // namespace
}  // namespace zonepack::localize
