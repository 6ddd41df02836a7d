// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace zonepack {

// A number of bytes; compare as `need > limit - used`.
using ByteCount = std::uint64_t;

inline constexpr ByteCount kKiB = 1024;
inline constexpr ByteCount kMiB = 1024 * kKiB;
inline constexpr ByteCount kGiB = 1024 * kMiB;

// Reads SIZE: decimal digits, or digits with suffix KiB, MiB or GiB ("8388608", "8MiB").
// Nothing else is accepted: no sign, blank, fraction, other unit or value over 2^63 - 1.
std::optional<ByteCount> parse_byte_count(std::string_view text) noexcept;

// The shortest exact SIZE ("8MiB"; "8388609").
std::string format_byte_count(ByteCount bytes);

}  // namespace zonepack
