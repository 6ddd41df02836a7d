// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/limits.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr unsigned kValueBits = 48;
constexpr std::uint64_t kMostValue = (std::uint64_t{1} << kValueBits) - 1;

}  // namespace

Error over_limit(LimitId id, std::uint64_t found) noexcept {
  const std::uint64_t row = static_cast<std::uint64_t>(id) << kValueBits;
  return {ErrorCode::kTooLarge, -1 - static_cast<std::int64_t>(row | std::min(found, kMostValue))};
}

std::optional<Excess> excess_of(const Error& error) noexcept {
  if (error.code != ErrorCode::kTooLarge || error.detail >= 0) return std::nullopt;
  const auto packed = static_cast<std::uint64_t>(-1 - error.detail);
  if (packed >> kValueBits >= kLimitCount) return std::nullopt;
  return Excess{static_cast<LimitId>(packed >> kValueBits), packed & kMostValue};
}

std::string to_string(const Excess& excess) {
  const Limit& row = limit(excess.id);
  return std::string(row.name) + ": " + std::to_string(excess.found) +
         ", the format holds at most " + std::to_string(row.most);
}

}  // namespace zonepack
