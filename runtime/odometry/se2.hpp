// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/odometry/pose.hpp"

// Poses of the plane and their uncertainty. Bit-exact: + - * / sqrt and det_math only.
// Covariances are of additive errors in x, y and yaw, each in its pose's parent frame.
namespace zonepack {

// T_a_c from T_a_b and T_b_c.
Pose2 compose(const Pose2& T_a_b, const Pose2& T_b_c) noexcept;

// T_b_a from T_a_b.
Pose2 inverse(const Pose2& T_a_b) noexcept;

// T_b_c from T_a_b and T_a_c.
Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c) noexcept;

// The pose reached by going `distance_m` along an arc while turning by `turn_rad`, exactly.
Pose2 along_arc(double distance_m, double turn_rad) noexcept;

// The same for a motion that goes `sideways_m` to the left of base_link at the same time, both at
// constant speed.
Pose2 along_arc(double forward_m, double sideways_m, double turn_rad) noexcept;

// The first `part` (0 to 1) of a motion that ran at constant speed along one arc.
Pose2 part_of_arc(const Pose2& motion, double part) noexcept;

// A pose and how sure it is.
struct UncertainPose {
  Pose2 pose;
  Covariance2 covariance;
};

// First-order propagation of compose(): errors of the two are independent.
UncertainPose compose(const UncertainPose& T_a_b, const UncertainPose& T_b_c) noexcept;

// T_a_b from T_a_c and an uncertain step T_b_c: compose() undone.
UncertainPose step_back(const UncertainPose& T_a_c, const UncertainPose& T_b_c) noexcept;

// Squared Mahalanobis distance of b - a under the sum of both covariances (yaw the short way).
// Infinite when the sum is not positive definite.
double mahalanobis2(const UncertainPose& a, const UncertainPose& b) noexcept;

// The two beliefs as one: the Kalman update of `prior` with a direct measurement.
// `prior` unchanged when the sum of both covariances is not positive definite.
UncertainPose fuse(const UncertainPose& prior, const UncertainPose& measured) noexcept;

// Largest standard deviation of the position over all directions, metres.
double position_sigma_m(const Covariance2& covariance) noexcept;

Covariance2 operator+(const Covariance2& a, const Covariance2& b) noexcept;
bool is_finite(const Pose2& pose) noexcept;

}  // namespace zonepack
