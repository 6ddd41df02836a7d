// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {

inline constexpr double kTurn_rad = 2 * kPi;
inline constexpr double kDegree_rad = kPi / 180;

// What the unit of a DBC signal means for odometry.
struct DbcUnit {
  enum class Kind : std::uint8_t {
    kNone,     // not given, or a word that names no quantity: "", "-", "raw"
    kLength,   // si: metres of one unit
    kAngle,    // si: radians of one unit; turns and rpm too
    kTicks,    // of an encoder
    kPercent,  // si: 0.01, of what odometry.full_scale says
    kUnknown,  // a quantity that odometry cannot use, or a spelling that is not known
  };
  Kind kind = Kind::kUnknown;
  double si = 1;
  bool per_time = false;  // si is per second
};

// Understands the spellings found in public DBC files, in any case and with any blanks: "km/h",
// "kph", "mm/s", "mph", "deg", "°" (UTF-8 or Latin-1), "deg/sec", "rpm", "1/min", "rev/min", "%".
DbcUnit parse_dbc_unit(std::string_view text);

}  // namespace zonepack
