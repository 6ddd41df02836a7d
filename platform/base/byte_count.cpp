// SPDX-License-Identifier: Apache-2.0
#include "platform/base/byte_count.hpp"

#include <charconv>
#include <limits>

namespace zonepack {
namespace {

struct Unit {
  const char* suffix;
  ByteCount bytes;
};
constexpr Unit kUnits[] = {{"GiB", kGiB}, {"MiB", kMiB}, {"KiB", kKiB}};
constexpr ByteCount kLargest = std::numeric_limits<std::int64_t>::max();

}  // namespace

std::optional<ByteCount> parse_byte_count(std::string_view text) noexcept {
  ByteCount unit = 1;
  for (const Unit& candidate : kUnits) {
    if (text.ends_with(candidate.suffix)) {
      unit = candidate.bytes;
      text.remove_suffix(3);
      break;
    }
  }
  ByteCount value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc() || rest != end || value > kLargest / unit) {
    return std::nullopt;
  }
  return value * unit;
}

std::string format_byte_count(ByteCount bytes) {
  for (const Unit& unit : kUnits) {
    if (bytes != 0 && bytes % unit.bytes == 0) {
      return std::to_string(bytes / unit.bytes) + unit.suffix;
    }
  }
  return std::to_string(bytes);
}

}  // namespace zonepack
