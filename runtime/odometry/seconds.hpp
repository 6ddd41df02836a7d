// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

inline constexpr double kSecondsPerNs = 1e-9;

// Negative when to_ns is the earlier one.
inline double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(to_ns - from_ns) * kSecondsPerNs;
}

inline double square(double value) noexcept { return value * value; }

}  // namespace zonepack
