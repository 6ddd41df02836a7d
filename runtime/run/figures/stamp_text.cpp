// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/stamp_text.hpp"

#include <charconv>

namespace zonepack {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kLastSecond = 9'000'000'000;
constexpr std::int64_t kFirstNanosecond = 100'000'000'000'000'000;

}  // namespace

bool parse_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

bool parse_stamp(std::string_view word, std::int64_t& stamp_ns) {
  std::int64_t seconds = 0;
  const char* const end = word.data() + word.size();
  auto [at, error] = std::from_chars(word.data(), end, seconds);
  if (error != std::errc() || word.starts_with('-')) return false;
  std::int64_t fraction_ns = 0;
  if (at != end && *at == '.') {
    std::int64_t unit_ns = kSecond_ns / 10;
    for (++at; at != end && *at >= '0' && *at <= '9'; ++at, unit_ns /= 10) {
      fraction_ns += (*at - '0') * unit_ns;
    }
  }
  if (at != end) {
    double value = 0;
    if (!parse_number(word, value) || !(value >= 0 && value < kLastSecond)) return false;
    stamp_ns = static_cast<std::int64_t>(value * kSecond_ns);
    return true;
  }
  // EuRoC and ROS write whole nanoseconds: 18 to 19 digits for any year from 1973 on.
  if (seconds >= kFirstNanosecond && word.find('.') == std::string_view::npos) {
    stamp_ns = seconds;
    return true;
  }
  if (seconds >= kLastSecond) return false;
  stamp_ns = seconds * kSecond_ns + fraction_ns;
  return true;
}

}  // namespace zonepack
