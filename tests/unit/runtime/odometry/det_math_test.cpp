// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/det_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace zonepack {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double error_of(double got, long double exact) {
  return static_cast<double>(std::abs(static_cast<long double>(got) - exact));
}

// Uniform in [-limit, limit] from the generator's bits alone: std::uniform_real_distribution
// differs between libraries.
double uniform(std::mt19937_64& random, double limit) {
  return (static_cast<double>(random() >> 11) * 0x1p-53 * 2 - 1) * limit;
}

// FNV-1a over bit patterns.
void mix(std::uint64_t& hash, double value) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3u;
}

TEST(DetMath, SineAndCosineKeepTheirDocumentedError) {
  std::mt19937_64 random(1);
  double worst_sin = 0;
  double worst_cos = 0;
  for (const double limit : {1e-9, 1e-3, 0.8, 3.2, 7.0, 100.0, 1e4, kLargestAngle_rad}) {
    for (int i = 0; i < 40'000; ++i) {
      const double angle = uniform(random, limit);
      worst_sin = std::max(worst_sin, error_of(det_sin(angle), std::sin((long double)angle)));
      worst_cos = std::max(worst_cos, error_of(det_cos(angle), std::cos((long double)angle)));
    }
  }
  // Next to multiples of pi/2, where the reduction cancels most.
  for (int n = -600'000; n <= 600'000; n += 101) {
    const double angle = n * (kPi / 2);
    worst_sin = std::max(worst_sin, error_of(det_sin(angle), std::sin((long double)angle)));
    worst_cos = std::max(worst_cos, error_of(det_cos(angle), std::cos((long double)angle)));
  }
  RecordProperty("worst_sin", std::to_string(worst_sin * 1e16));
  RecordProperty("worst_cos", std::to_string(worst_cos * 1e16));
  EXPECT_LT(worst_sin, 1.5e-16);
  EXPECT_LT(worst_cos, 1.5e-16);
}

TEST(DetMath, SmallSinesAreRelativelyExact) {
  for (double angle = 1e-300; angle < 0.1; angle *= 7) {
    EXPECT_LT(error_of(det_sin(angle), std::sin((long double)angle)), angle * 2.3e-16) << angle;
  }
  EXPECT_EQ(det_sin(0.0), 0.0);
  EXPECT_EQ(det_cos(0.0), 1.0);
}

TEST(DetMath, AnglesOutsideTheDomainGiveNan) {
  for (const double bad : {kInf, -kInf, kNan, kLargestAngle_rad * 1.001, -1e300}) {
    EXPECT_TRUE(std::isnan(det_sin(bad))) << bad;
    EXPECT_TRUE(std::isnan(det_cos(bad))) << bad;
    EXPECT_TRUE(std::isnan(wrap_angle(bad))) << bad;
  }
}

TEST(DetMath, ArcTangentKeepsItsDocumentedError) {
  std::mt19937_64 random(2);
  double worst = 0;
  for (const double limit : {1e-6, 0.05, 1.0, 8.0, 1e9}) {
    for (int i = 0; i < 60'000; ++i) {
      const double y = uniform(random, limit);
      const double x = uniform(random, 1.0);
      worst =
          std::max(worst, error_of(det_atan2(y, x), std::atan2((long double)y, (long double)x)));
    }
  }
  RecordProperty("worst_atan2", std::to_string(worst * 1e16));
  EXPECT_LT(worst, 5e-16);
  for (double y = 1e-300; y < 0.06; y *= 5) {
    EXPECT_LT(error_of(det_atan2(y, 1), std::atan2((long double)y, 1.0L)), y * 4.5e-16) << y;
  }
}

TEST(DetMath, ArcTangentOfAxesAndExtremes) {
  EXPECT_EQ(det_atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(det_atan2(0.0, 1.0), 0.0);
  EXPECT_EQ(det_atan2(0.0, -1.0), kPi);
  EXPECT_EQ(det_atan2(-0.0, -1.0), kPi);  // yaw stays in (-pi, pi]
  EXPECT_EQ(det_atan2(1.0, 0.0), kPi / 2);
  EXPECT_EQ(det_atan2(-1.0, 0.0), -kPi / 2);
  EXPECT_EQ(det_atan2(1.0, 1.0), kPi / 4);
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(det_atan2(most, most), kPi / 4);
  EXPECT_EQ(det_atan2(most, -most), kPi - kPi / 4);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(det_atan2(least, least), kPi / 4);
  EXPECT_TRUE(std::isnan(det_atan2(kInf, 1)));
  EXPECT_TRUE(std::isnan(det_atan2(1, kNan)));
}

TEST(DetMath, WrappedAnglesLieInTheHalfOpenTurn) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(3.0), 3.0);
  EXPECT_NEAR(wrap_angle(3 * kPi), kPi, 1e-15);
  EXPECT_NEAR(wrap_angle(kPi + 0.25), -kPi + 0.25, 1e-15);
  std::mt19937_64 random(3);
  for (int i = 0; i < 100'000; ++i) {
    const double angle = uniform(random, i % 2 == 0 ? 10.0 : kLargestAngle_rad);
    const double wrapped = wrap_angle(angle);
    ASSERT_GT(wrapped, -kPi);
    ASSERT_LE(wrapped, kPi);
    const double off =
        error_of(wrapped, std::atan2(std::sin((long double)angle), std::cos((long double)angle)));
    ASSERT_LT(std::min(off, std::abs(off - 2 * kPi)), 1e-15) << angle;
  }
}

// The contract itself: these bits are the same with gcc and clang, in Debug and Release, with and
// without FMA, on x86-64 and arm.
TEST(DetMath, GivesTheSameBitsEverywhere) {
  EXPECT_EQ(det_sin(0.5), 0x1.eaee8744b05fp-2);
  EXPECT_EQ(det_cos(2.0), -0x1.aa22657537205p-2);
  EXPECT_EQ(det_sin(1e5), 0x1.24daa9c527e96p-5);
  EXPECT_EQ(det_atan2(1.0, 3.0), 0x1.4978fa3269ee2p-2);
  EXPECT_EQ(det_atan2(-2.0, -7.0), -0x1.6e8062854db5ep+1);
  EXPECT_EQ(wrap_angle(12345.678), -0x1.8ff016c1b1aafp-1);
  std::mt19937_64 random(4);
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (int i = 0; i < 100'000; ++i) {
    const double angle = uniform(random, i % 3 == 0 ? 1e4 : 4.0);
    mix(hash, det_sin(angle));
    mix(hash, det_cos(angle));
    mix(hash, wrap_angle(angle));
    mix(hash, det_atan2(angle, uniform(random, 4.0)));
  }
  EXPECT_EQ(hash, 0x7223046842e29d65u);
}

}  // namespace
}  // namespace zonepack
