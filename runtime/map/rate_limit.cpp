// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/rate_limit.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// Rounded up, so that rounding never raises the rate. For up to 9 GB at once.
std::int64_t time_for(ByteCount bytes, std::uint64_t bytes_per_s) noexcept {
  constexpr ByteCount kMost = 9'000'000'000;
  const std::uint64_t cost = std::min(bytes, kMost) * std::uint64_t{kSecond};
  return static_cast<std::int64_t>(cost / bytes_per_s + (cost % bytes_per_s != 0 ? 1 : 0));
}

}  // namespace

RateLimit::RateLimit(std::uint64_t bytes_per_s, ByteCount burst) noexcept
    : bytes_per_s_(bytes_per_s), burst_ns_(bytes_per_s == 0 ? 0 : time_for(burst, bytes_per_s)) {}

std::int64_t RateLimit::spend(ByteCount bytes, std::int64_t now_ns) noexcept {
  if (bytes_per_s_ == 0) return 0;
  paid_ns_ = std::max(paid_ns_, now_ns - burst_ns_) + time_for(bytes, bytes_per_s_);
  return std::max<std::int64_t>(0, paid_ns_ - now_ns);
}

}  // namespace zonepack
