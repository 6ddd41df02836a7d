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

// Reads SIZE: "8388608", "6.8MiB", "8M" (a MiB, as K and G), "50MB" (1000 kB), at most 2^63 - 1.
// A unit may follow a blank; a fraction needs a unit, has up to 9 digits and is rounded down.
std::optional<ByteCount> parse_byte_count(std::string_view text) noexcept;

// The shortest exact SIZE ("8MiB"; "8388609").
std::string format_byte_count(ByteCount bytes);

// A size for people, rounded to a table's width: "512 B", "20 KiB", "1.50 MiB".
std::string short_bytes(ByteCount bytes);

}  // namespace zonepack
