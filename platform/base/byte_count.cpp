// SPDX-License-Identifier: Apache-2.0
#include "platform/base/byte_count.hpp"

#include <charconv>
#include <cstdio>
#include <limits>

namespace zonepack {
namespace {

struct Unit {
  const char* suffix;
  ByteCount bytes;
};
// Those that format_byte_count() writes, largest first.
constexpr Unit kUnits[] = {{"GiB", kGiB}, {"MiB", kMiB}, {"KiB", kKiB}};
// What people write besides: letters alone are binary, as for dd and systemd.
constexpr Unit kOtherUnits[] = {{"G", kGiB},  {"M", kMiB},          {"K", kKiB},
                                {"k", kKiB},  {"GB", 1000'000'000}, {"MB", 1000'000},
                                {"kB", 1000}, {"KB", 1000},         {"B", 1}};
constexpr ByteCount kLargest = std::numeric_limits<std::int64_t>::max();

std::optional<ByteCount> unit_of(std::string_view suffix) noexcept {
  for (const Unit& unit : kUnits) {
    if (suffix == unit.suffix) return unit.bytes;
  }
  for (const Unit& unit : kOtherUnits) {
    if (suffix == unit.suffix) return unit.bytes;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ByteCount> parse_byte_count(std::string_view text) noexcept {
  const char* const end = text.data() + text.size();
  ByteCount value = 0;
  auto [at, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc()) return std::nullopt;
  ByteCount fraction = 0, parts = 1;  // fraction / parts of a unit
  const bool has_fraction = at != end && *at == '.';
  if (has_fraction) {
    const char* const first = ++at;
    for (; at != end && *at >= '0' && *at <= '9' && at - first < 9; ++at) {
      fraction = fraction * 10 + static_cast<ByteCount>(*at - '0');
      parts *= 10;
    }
    if (at == first) return std::nullopt;
  }
  if (at == end) return has_fraction || value > kLargest ? std::nullopt : std::optional(value);
  if (*at == ' ') ++at;
  const std::optional<ByteCount> unit =
      unit_of(std::string_view(at, static_cast<std::size_t>(end - at)));
  if (!unit || (has_fraction && *unit == 1) || value > kLargest / *unit) return std::nullopt;
  const ByteCount whole = value * *unit, rest = fraction * *unit / parts;
  if (rest > kLargest - whole) return std::nullopt;
  return whole + rest;
}

std::string format_byte_count(ByteCount bytes) {
  for (const Unit& unit : kUnits) {
    if (bytes != 0 && bytes % unit.bytes == 0) {
      return std::to_string(bytes / unit.bytes) + unit.suffix;
    }
  }
  return std::to_string(bytes);
}

std::string short_bytes(ByteCount bytes) {
  if (bytes < kKiB) return std::to_string(bytes) + " B";
  char text[32];
  const double kib = static_cast<double>(bytes) / static_cast<double>(kKiB);
  if (kib < 1023.5) {
    std::snprintf(text, sizeof text, "%.0f KiB", kib);
  } else {
    std::snprintf(text, sizeof text, "%.2f MiB", kib / 1024);
  }
  return text;
}

}  // namespace zonepack
