// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/se2.hpp"

#include <cmath>
#include <limits>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

// Inverse of a symmetric 3x3 by cofactors; false when it is not positive definite.
bool invert(const Covariance2& a, Covariance2& inverse_of_a) noexcept {
  const double c_xx = a.yy * a.yaw_yaw - a.y_yaw * a.y_yaw;
  const double c_xy = a.x_yaw * a.y_yaw - a.xy * a.yaw_yaw;
  const double c_xt = a.xy * a.y_yaw - a.x_yaw * a.yy;
  const double minor = a.xx * a.yy - a.xy * a.xy;
  const double determinant = a.xx * c_xx + a.xy * c_xy + a.x_yaw * c_xt;
  if (!(a.xx > 0) || !(minor > 0) || !(determinant > 0)) return false;
  const double c_yy = a.xx * a.yaw_yaw - a.x_yaw * a.x_yaw;
  const double c_yt = a.xy * a.x_yaw - a.xx * a.y_yaw;
  inverse_of_a = {c_xx / determinant, c_xy / determinant, c_xt / determinant,
                  c_yy / determinant, c_yt / determinant, minor / determinant};
  return true;
}

// J P J^T for J = [1 0 jx; 0 1 jy; 0 0 1].
Covariance2 shear(const Covariance2& p, double jx, double jy) noexcept {
  Covariance2 out;
  out.x_yaw = p.x_yaw + jx * p.yaw_yaw;
  out.y_yaw = p.y_yaw + jy * p.yaw_yaw;
  out.xx = p.xx + jx * p.x_yaw + jx * out.x_yaw;
  out.xy = p.xy + jy * p.x_yaw + jx * out.y_yaw;
  out.yy = p.yy + jy * p.y_yaw + jy * out.y_yaw;
  out.yaw_yaw = p.yaw_yaw;
  return out;
}

// R P R^T for a rotation of x and y.
Covariance2 rotate(const Covariance2& p, double cosine, double sine) noexcept {
  const double cc = cosine * cosine;
  const double ss = sine * sine;
  const double cs = cosine * sine;
  return {cc * p.xx - 2 * cs * p.xy + ss * p.yy, cs * (p.xx - p.yy) + (cc - ss) * p.xy,
          cosine * p.x_yaw - sine * p.y_yaw,     ss * p.xx + 2 * cs * p.xy + cc * p.yy,
          sine * p.x_yaw + cosine * p.y_yaw,     p.yaw_yaw};
}

}  // namespace

Pose2 compose(const Pose2& T_a_b, const Pose2& T_b_c) noexcept {
  const double c = det_cos(T_a_b.yaw_rad);
  const double s = det_sin(T_a_b.yaw_rad);
  return {T_a_b.x_m + c * T_b_c.x_m - s * T_b_c.y_m, T_a_b.y_m + s * T_b_c.x_m + c * T_b_c.y_m,
          wrap_angle(T_a_b.yaw_rad + T_b_c.yaw_rad)};
}

Pose2 inverse(const Pose2& T_a_b) noexcept {
  const double c = det_cos(T_a_b.yaw_rad);
  const double s = det_sin(T_a_b.yaw_rad);
  return {-(c * T_a_b.x_m + s * T_a_b.y_m), s * T_a_b.x_m - c * T_a_b.y_m,
          wrap_angle(-T_a_b.yaw_rad)};
}

Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c) noexcept {
  return compose(inverse(T_a_b), T_a_c);
}

Pose2 along_arc(double distance_m, double turn_rad) noexcept {
  const double half = turn_rad * 0.5;
  const double h2 = half * half;
  // sin(half) / half; the series is exact to the last bit below 1e-3.
  const double chord = distance_m * (h2 < 1e-6 ? 1 - h2 / 6 + h2 * h2 / 120 : det_sin(half) / half);
  return {chord * det_cos(half), chord * det_sin(half), wrap_angle(turn_rad)};
}

Pose2 along_arc(double forward_m, double sideways_m, double turn_rad) noexcept {
  Pose2 pose = along_arc(forward_m, turn_rad);
  if (sideways_m == 0) return pose;
  const Pose2 aside = along_arc(sideways_m, turn_rad);
  pose.x_m -= aside.y_m;
  pose.y_m += aside.x_m;
  return pose;
}

Pose2 part_of_arc(const Pose2& motion, double part) noexcept {
  // Turned back by half the turn, the chord lies along x but for slip, which is split evenly.
  const double half = motion.yaw_rad * 0.5;
  const double h2 = half * half;
  const double ratio = h2 < 1e-6 ? 1 - h2 / 6 + h2 * h2 / 120 : det_sin(half) / half;
  const double c = det_cos(half);
  const double s = det_sin(half);
  const double along = (c * motion.x_m + s * motion.y_m) / ratio;
  const double across = -s * motion.x_m + c * motion.y_m;
  Pose2 reached = along_arc(along * part, motion.yaw_rad * part);
  reached.x_m -= s * across * part;
  reached.y_m += c * across * part;
  return reached;
}

UncertainPose compose(const UncertainPose& T_a_b, const UncertainPose& T_b_c) noexcept {
  const double c = det_cos(T_a_b.pose.yaw_rad);
  const double s = det_sin(T_a_b.pose.yaw_rad);
  const Pose2& step = T_b_c.pose;
  const double dx = c * step.x_m - s * step.y_m;
  const double dy = s * step.x_m + c * step.y_m;
  return {{T_a_b.pose.x_m + dx, T_a_b.pose.y_m + dy, wrap_angle(T_a_b.pose.yaw_rad + step.yaw_rad)},
          shear(T_a_b.covariance, -dy, dx) + rotate(T_b_c.covariance, c, s)};
}

UncertainPose step_back(const UncertainPose& T_a_c, const UncertainPose& T_b_c) noexcept {
  const double yaw = wrap_angle(T_a_c.pose.yaw_rad - T_b_c.pose.yaw_rad);
  const double c = det_cos(yaw);
  const double s = det_sin(yaw);
  const double dx = c * T_b_c.pose.x_m - s * T_b_c.pose.y_m;
  const double dy = s * T_b_c.pose.x_m + c * T_b_c.pose.y_m;
  const Covariance2 sum = T_a_c.covariance + rotate(T_b_c.covariance, c, s);
  return {{T_a_c.pose.x_m - dx, T_a_c.pose.y_m - dy, yaw}, shear(sum, dy, -dx)};
}

double mahalanobis2(const UncertainPose& a, const UncertainPose& b) noexcept {
  Covariance2 w;
  if (!invert(a.covariance + b.covariance, w)) return std::numeric_limits<double>::infinity();
  const double x = b.pose.x_m - a.pose.x_m;
  const double y = b.pose.y_m - a.pose.y_m;
  const double t = wrap_angle(b.pose.yaw_rad - a.pose.yaw_rad);
  return x * (w.xx * x + w.xy * y + w.x_yaw * t) + y * (w.xy * x + w.yy * y + w.y_yaw * t) +
         t * (w.x_yaw * x + w.y_yaw * y + w.yaw_yaw * t);
}

UncertainPose fuse(const UncertainPose& prior, const UncertainPose& measured) noexcept {
  const Covariance2& p = prior.covariance;
  const Covariance2& r = measured.covariance;
  Covariance2 w;
  if (!invert(p + r, w)) return prior;
  // K = P (P + R)^-1, row by row.
  const double kxx = p.xx * w.xx + p.xy * w.xy + p.x_yaw * w.x_yaw;
  const double kxy = p.xx * w.xy + p.xy * w.yy + p.x_yaw * w.y_yaw;
  const double kxt = p.xx * w.x_yaw + p.xy * w.y_yaw + p.x_yaw * w.yaw_yaw;
  const double kyx = p.xy * w.xx + p.yy * w.xy + p.y_yaw * w.x_yaw;
  const double kyy = p.xy * w.xy + p.yy * w.yy + p.y_yaw * w.y_yaw;
  const double kyt = p.xy * w.x_yaw + p.yy * w.y_yaw + p.y_yaw * w.yaw_yaw;
  const double ktx = p.x_yaw * w.xx + p.y_yaw * w.xy + p.yaw_yaw * w.x_yaw;
  const double kty = p.x_yaw * w.xy + p.y_yaw * w.yy + p.yaw_yaw * w.y_yaw;
  const double ktt = p.x_yaw * w.x_yaw + p.y_yaw * w.y_yaw + p.yaw_yaw * w.yaw_yaw;
  const double x = measured.pose.x_m - prior.pose.x_m;
  const double y = measured.pose.y_m - prior.pose.y_m;
  const double t = wrap_angle(measured.pose.yaw_rad - prior.pose.yaw_rad);
  // P (P + R)^-1 R: symmetric and positive for any positive P and R.
  Covariance2 fused;
  fused.xx = kxx * r.xx + kxy * r.xy + kxt * r.x_yaw;
  fused.xy = kxx * r.xy + kxy * r.yy + kxt * r.y_yaw;
  fused.x_yaw = kxx * r.x_yaw + kxy * r.y_yaw + kxt * r.yaw_yaw;
  fused.yy = kyx * r.xy + kyy * r.yy + kyt * r.y_yaw;
  fused.y_yaw = kyx * r.x_yaw + kyy * r.y_yaw + kyt * r.yaw_yaw;
  fused.yaw_yaw = ktx * r.x_yaw + kty * r.y_yaw + ktt * r.yaw_yaw;
  return {
      {prior.pose.x_m + kxx * x + kxy * y + kxt * t, prior.pose.y_m + kyx * x + kyy * y + kyt * t,
       wrap_angle(prior.pose.yaw_rad + ktx * x + kty * y + ktt * t)},
      fused};
}

double position_sigma_m(const Covariance2& covariance) noexcept {
  const double mean = (covariance.xx + covariance.yy) * 0.5;
  const double half = (covariance.xx - covariance.yy) * 0.5;
  const double largest = mean + std::sqrt(half * half + covariance.xy * covariance.xy);
  return largest > 0 ? std::sqrt(largest) : 0;
}

Covariance2 operator+(const Covariance2& a, const Covariance2& b) noexcept {
  return {a.xx + b.xx, a.xy + b.xy,       a.x_yaw + b.x_yaw,
          a.yy + b.yy, a.y_yaw + b.y_yaw, a.yaw_yaw + b.yaw_yaw};
}

bool is_finite(const Pose2& pose) noexcept {
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.yaw_rad);
}

}  // namespace zonepack
