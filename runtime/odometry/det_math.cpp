// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/det_math.hpp"

#include <cfloat>
#include <cstdint>
#include <limits>

namespace zonepack {
namespace {

static_assert(FLT_EVAL_METHOD == 0, "needs IEEE doubles without excess precision (not x87)");

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// pi/2 in three parts; the first two have 33 bits, so that n times either is exact for n < 2^20.
constexpr double kHalfPi1 = 1.57079632673412561417e+00;
constexpr double kHalfPi2 = 6.07710050630396597660e-11;
constexpr double kHalfPi3 = 2.02226624879595063154e-21;

// atan(k / 8).
constexpr double kAtanEighths[] = {
    0.0,
    0.12435499454676143503135484916387,
    0.24497866312686415417208248121128,
    0.35877067027057222039592006392646,
    0.46364760900080611621425623146121,
    0.55859931534356243597150821640166,
    0.64350110879328438680280922871732,
    0.71882999962162450541701415152590,
    0.78539816339744830961566084581988,
};

// An angle as a quarter turn (mod 4) and a rest in [-pi/4, pi/4], the rest as a sum.
struct Reduced {
  int quarter;
  double rest;
  double rest_low;
};

double nearest_integer(double value) noexcept {
  return static_cast<double>(static_cast<std::int64_t>(value + (value < 0 ? -0.5 : 0.5)));
}

bool in_domain(double angle) noexcept {
  return angle >= -kLargestAngle_rad && angle <= kLargestAngle_rad;
}

Reduced reduce(double angle) noexcept {
  const double n = nearest_integer(angle * (2 / kPi));
  const double first = angle - n * kHalfPi1;
  const double second = n * kHalfPi2;
  const double high = first - second;
  const double low = ((first - high) - second) - n * kHalfPi3;
  const double rest = high + low;
  return {static_cast<int>(static_cast<std::int64_t>(n) & 3), rest, (high - rest) + low};
}

double sine_of(const Reduced& a) noexcept {
  const double x = a.rest;
  const double z = x * x;
  double series = -1.0 / 1307674368000.0;
  series = series * z + 1.0 / 6227020800.0;
  series = series * z - 1.0 / 39916800.0;
  series = series * z + 1.0 / 362880.0;
  series = series * z - 1.0 / 5040.0;
  series = series * z + 1.0 / 120.0;
  series = series * z - 1.0 / 6.0;
  return x + (x * z * series + a.rest_low * (1.0 - z * 0.5));
}

double cosine_of(const Reduced& a) noexcept {
  const double x = a.rest;
  const double z = x * x;
  double series = 1.0 / 20922789888000.0;
  series = series * z - 1.0 / 87178291200.0;
  series = series * z + 1.0 / 479001600.0;
  series = series * z - 1.0 / 3628800.0;
  series = series * z + 1.0 / 40320.0;
  series = series * z - 1.0 / 720.0;
  series = series * z + 1.0 / 24.0;
  const double half = z * 0.5;
  const double most = 1.0 - half;
  return most + (((1.0 - most) - half) + (z * z * series - x * a.rest_low));
}

// atan(small / large) for 0 <= small <= large, 0 < large.
double atan_octant(double small, double large) noexcept {
  const auto k = static_cast<int>(small / large * 8.0 + 0.5);
  const double c = k / 8.0;
  const double t = k == 0 ? small / large : (small - c * large) / (large + c * small);
  const double z = t * t;
  double series = -1.0 / 15.0;
  series = series * z + 1.0 / 13.0;
  series = series * z - 1.0 / 11.0;
  series = series * z + 1.0 / 9.0;
  series = series * z - 1.0 / 7.0;
  series = series * z + 1.0 / 5.0;
  series = series * z - 1.0 / 3.0;
  return kAtanEighths[k] + (t + t * z * series);
}

bool is_finite_number(double value) noexcept { return value - value == 0; }

}  // namespace

double det_sin(double angle_rad) noexcept {
  if (!in_domain(angle_rad)) return kNan;
  const Reduced a = reduce(angle_rad);
  switch (a.quarter) {
    case 0:
      return sine_of(a);
    case 1:
      return cosine_of(a);
    case 2:
      return -sine_of(a);
    default:
      return -cosine_of(a);
  }
}

double det_cos(double angle_rad) noexcept {
  if (!in_domain(angle_rad)) return kNan;
  const Reduced a = reduce(angle_rad);
  switch (a.quarter) {
    case 0:
      return cosine_of(a);
    case 1:
      return -sine_of(a);
    case 2:
      return -cosine_of(a);
    default:
      return sine_of(a);
  }
}

double det_atan2(double y, double x) noexcept {
  if (!is_finite_number(y) || !is_finite_number(x)) return kNan;
  double abs_y = y < 0 ? -y : y;
  double abs_x = x < 0 ? -x : x;
  if (abs_y == 0 && abs_x == 0) return 0;
  if (abs_y > 0x1p1000 || abs_x > 0x1p1000) {
    abs_y *= 0x1p-30;
    abs_x *= 0x1p-30;
  }
  double angle = abs_y <= abs_x ? atan_octant(abs_y, abs_x) : kPi / 2 - atan_octant(abs_x, abs_y);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

double wrap_angle(double angle_rad) noexcept {
  if (!in_domain(angle_rad)) return kNan;
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  if (angle_rad == -kPi) return kPi;
  const double turns = 4 * nearest_integer(angle_rad / (2 * kPi));
  double wrapped = ((angle_rad - turns * kHalfPi1) - turns * kHalfPi2) - turns * kHalfPi3;
  if (wrapped > kPi) wrapped -= 2 * kPi;
  if (wrapped <= -kPi) wrapped += 2 * kPi;
  return wrapped;
}

}  // namespace zonepack
