// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime/odometry/se2.hpp"

namespace zonepack {

// Whether a localizer's fixes are as far from the pose as their covariance says: the mean of their
// squared Mahalanobis distances over the last kFixes or so (normalised innovation squared), which
// is 3 for x, y and yaw that are honest. Fixes that claim too much are counted for less, so that
// neither the pose follows each of them nor the gate refuses what is right.
//
// Real-time: a few operations, no allocation.
class FixConsistency {
 public:
  static constexpr double kExpected = 3;
  static constexpr double kTolerated = 2;  // times that: maps are bent, wheels slip
  static constexpr double kFixes = 32;
  static constexpr double kMostOfOne = 60;  // a wrong fix says nothing about the others

  void add(double distance2) noexcept {
    // Also what is not a number counts as far.
    const double bounded = distance2 < kMostOfOne ? distance2 : kMostOfOne;
    mean_ += (bounded - mean_) / kFixes;
    ++fixes_;
  }

  // By what variances are to be multiplied: 1 for honest fixes, at most 10.
  double widening() const noexcept { return std::max(1.0, mean_ / (kExpected * kTolerated)); }

  UncertainPose widened(const UncertainPose& fix) const noexcept {
    const double by = widening();
    if (by == 1) return fix;
    const Covariance2& c = fix.covariance;
    return {fix.pose,
            {c.xx * by, c.xy * by, c.x_yaw * by, c.yy * by, c.y_yaw * by, c.yaw_yaw * by}};
  }

  double mean() const noexcept { return mean_; }
  std::uint64_t fixes() const noexcept { return fixes_; }

 private:
  double mean_ = kExpected;
  std::uint64_t fixes_ = 0;
};

}  // namespace zonepack
