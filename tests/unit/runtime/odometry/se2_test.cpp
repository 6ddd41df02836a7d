// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/se2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

void expect_near(const Pose2& a, const Pose2& b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x_m, b.x_m, tolerance);
  EXPECT_NEAR(a.y_m, b.y_m, tolerance);
  EXPECT_NEAR(wrap_angle(a.yaw_rad - b.yaw_rad), 0, tolerance);
}

Covariance2 diagonal(double xx, double yy, double yaw) {
  Covariance2 c;
  c.xx = xx;
  c.yy = yy;
  c.yaw_yaw = yaw;
  return c;
}

TEST(Se2, ComposesPoses) {
  // From (1, 2) facing up, 3 ahead and 1 to the left is (0, 5).
  expect_near(compose(Pose2{1, 2, kPi / 2}, Pose2{3, 1, kPi / 2}), {0, 5, kPi});
  expect_near(compose(Pose2{0, 0, 3}, Pose2{0, 0, 3}), {0, 0, 6 - 2 * kPi});
}

TEST(Se2, InverseAndBetweenUndoCompose) {
  const Pose2 a{1, -2, 2.5};
  const Pose2 b{-0.3, 4, -1.2};
  expect_near(compose(a, inverse(a)), {0, 0, 0});
  expect_near(between(a, compose(a, b)), b);
}

TEST(Se2, ArcsAreExact) {
  // A quarter circle to the left of radius 2 is pi long and ends at (2, 2).
  expect_near(along_arc(kPi, kPi / 2), {2, 2, kPi / 2});
  expect_near(along_arc(5, 0), {5, 0, 0});
  expect_near(along_arc(0, 1), {0, 0, 1});
  expect_near(along_arc(-kPi, -kPi / 2), {-2, 2, -kPi / 2});
  // On both sides of the series' limit.
  expect_near(along_arc(1, 1.999999e-3), along_arc(1, 2.000001e-3), 2e-9);
}

TEST(Se2, TwoPartsOfAnArcMakeTheWhole) {
  const Pose2 arc = along_arc(1.7, -0.8);
  for (const double part : {0.0, 0.2, 0.5, 1.0}) {
    expect_near(part_of_arc(arc, part), along_arc(1.7 * part, -0.8 * part));
    const Pose2 rest = between(part_of_arc(arc, part), arc);
    expect_near(rest, along_arc(1.7 * (1 - part), -0.8 * (1 - part)));
  }
}

// The Jacobians against many samples of the same noise.
TEST(Se2, PropagatedCovarianceMatchesSampledOne) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const UncertainPose a{{2, 1, 0.7}, diagonal(0.04, 0.01, 0.0025)};
  const UncertainPose step{{0.8, 0.3, 0.4}, diagonal(0.0009, 0.0004, 0.0001)};
  const UncertainPose sum = compose(a, step);
  double sxx = 0, sxy = 0, sxt = 0, syy = 0, syt = 0, stt = 0;
  constexpr int kSamples = 200'000;
  for (int i = 0; i < kSamples; ++i) {
    const auto drawn = [&](const UncertainPose& p) {
      return Pose2{p.pose.x_m + std::sqrt(p.covariance.xx) * normal(random),
                   p.pose.y_m + std::sqrt(p.covariance.yy) * normal(random),
                   p.pose.yaw_rad + std::sqrt(p.covariance.yaw_yaw) * normal(random)};
    };
    const Pose2 reached = compose(drawn(a), drawn(step));
    const double x = reached.x_m - sum.pose.x_m;
    const double y = reached.y_m - sum.pose.y_m;
    const double t = wrap_angle(reached.yaw_rad - sum.pose.yaw_rad);
    sxx += x * x, sxy += x * y, sxt += x * t, syy += y * y, syt += y * t, stt += t * t;
  }
  EXPECT_NEAR(sum.covariance.xx, sxx / kSamples, 4e-4);
  EXPECT_NEAR(sum.covariance.xy, sxy / kSamples, 4e-4);
  EXPECT_NEAR(sum.covariance.x_yaw, sxt / kSamples, 1e-4);
  EXPECT_NEAR(sum.covariance.yy, syy / kSamples, 4e-4);
  EXPECT_NEAR(sum.covariance.y_yaw, syt / kSamples, 1e-4);
  EXPECT_NEAR(sum.covariance.yaw_yaw, stt / kSamples, 1e-4);
}

TEST(Se2, StepBackUndoesCompose) {
  const UncertainPose step{{0.8, 0.3, 0.4}, {}};
  const UncertainPose start{{2, 1, 0.7}, {0.04, 0.001, 0.002, 0.01, 0.003, 0.0025}};
  const UncertainPose there_and_back = step_back(compose(start, step), step);
  expect_near(there_and_back.pose, start.pose);
  EXPECT_NEAR(there_and_back.covariance.xx, start.covariance.xx, 1e-12);
  EXPECT_NEAR(there_and_back.covariance.xy, start.covariance.xy, 1e-12);
  EXPECT_NEAR(there_and_back.covariance.y_yaw, start.covariance.y_yaw, 1e-12);
}

TEST(Se2, MahalanobisDistanceOfIndependentAxes) {
  const UncertainPose a{{0, 0, 3.0}, diagonal(0.03, 0.3, 0.05)};
  const UncertainPose b{{0.4, 1, -3.0}, diagonal(0.01, 0.2, 0.05)};
  // 0.4^2 / 0.04 + 1^2 / 0.5 + (2 pi - 6)^2 / 0.1
  const double turn = 2 * kPi - 6;
  EXPECT_NEAR(mahalanobis2(a, b), 4 + 2 + turn * turn / 0.1, 1e-12);
  EXPECT_EQ(mahalanobis2({}, {}), std::numeric_limits<double>::infinity());
}

TEST(Se2, FusingWeighsByCertainty) {
  const UncertainPose prior{{0, 0, 0}, diagonal(0.03, 1, 1)};
  const UncertainPose measured{{4, 2, 0.5}, diagonal(0.01, 1, 1)};
  const UncertainPose fused = fuse(prior, measured);
  expect_near(fused.pose, {3, 1, 0.25});  // weights 3:1 and 1:1
  EXPECT_NEAR(fused.covariance.xx, 0.03 * 0.01 / 0.04, 1e-15);
  EXPECT_NEAR(fused.covariance.yy, 0.5, 1e-15);
  const UncertainPose across =
      fuse({{0, 0, kPi - 0.1}, diagonal(1, 1, 1)}, {{0, 0, -kPi + 0.3}, diagonal(1, 1, 1)});
  expect_near(across.pose, {0, 0, -kPi + 0.1});  // the middle of -0.1 and +0.3 around pi
}

TEST(Se2, FusingNeverLosesPositiveVariances) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  UncertainPose state{{0, 0, 0}, diagonal(1e4, 1e4, 10)};
  for (int i = 0; i < 5'000; ++i) {
    state =
        compose(state, {along_arc(uniform(random), uniform(random)), diagonal(1e-8, 1e-10, 1e-9)});
    state = fuse(state, {state.pose, diagonal(1e-4, 25, 1e-6)});
    ASSERT_GT(state.covariance.xx, 0);
    ASSERT_GT(state.covariance.yy, 0);
    ASSERT_GT(state.covariance.yaw_yaw, 0);
    ASSERT_GT(state.covariance.xx * state.covariance.yy, state.covariance.xy * state.covariance.xy);
  }
}

}  // namespace
}  // namespace zonepack
