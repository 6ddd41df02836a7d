// SPDX-License-Identifier: Apache-2.0
#pragma once

// Sine, cosine and arc tangent with the same bits on every CPU, compiler and C library.
//
// libm's differ between architectures and even between two CPUs (its variants with FMA are chosen
// at run time), so code that decides uses these: only + - * / on doubles, in a fixed order, built
// with -ffp-contract=off. Taylor series after reduction to a short interval; every constant can be
// checked by hand.
// Real-time: no allocation, no table built at start, a fixed number of operations.
namespace zonepack {

inline constexpr double kPi = 3.14159265358979323846;

// Largest difference to the exact value: 1.5e-16, |angle| <= kLargestAngle_rad. NaN for anything
// else: not finite, or larger than any angle that is kept wrapped.
inline constexpr double kLargestAngle_rad = 1e6;
double det_sin(double angle_rad) noexcept;
double det_cos(double angle_rad) noexcept;

// Angle of (x, y) in (-pi, pi]; the sign of a zero is ignored: 0 for (0, 0), pi for (-1, -0.0).
// Largest difference to the exact value: 5e-16; relative 4.5e-16 near 0. NaN when
// an argument is not finite. Quotients that underflow give 0.
double det_atan2(double y, double x) noexcept;

// The same direction in (-pi, pi]. Largest error 1e-15; angles already inside come back bit for
// bit. NaN beyond kLargestAngle_rad.
double wrap_angle(double angle_rad) noexcept;

}  // namespace zonepack
