// SPDX-License-Identifier: Apache-2.0
#include "platform/process/stamp_converter.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr std::int64_t kTolerance_ns = 1'000'000;
constexpr std::int64_t kBucket_ns = 1'000'000'000;
constexpr std::int64_t kLongestDelay_ns = 20'000'000;

}  // namespace

void StampConverter::restart(std::int64_t after_ns) noexcept {
  after_ns_ = after_ns;
  older_offset_ns_ = offset_ns_;
}

void StampConverter::read_between(std::int64_t began_ns, std::int64_t ended_ns,
                                  std::int64_t offset_ns) noexcept {
  began_ns_ = began_ns;
  ended_ns_ = ended_ns;
  offset_ns_ = offset_ns;
}

std::int64_t StampConverter::monotonic_of(std::int64_t realtime_ns) const noexcept {
  const auto fits = [this](std::int64_t t_ns) {
    return t_ns >= after_ns_ - kTolerance_ns && t_ns <= ended_ns_ + kTolerance_ns;
  };
  const std::int64_t by_newest_ns = realtime_ns - offset_ns_;
  const std::int64_t by_older_ns = realtime_ns - older_offset_ns_;
  const bool older = !fits(by_newest_ns) && fits(by_older_ns);
  return std::clamp(older ? by_older_ns : by_newest_ns, std::min(after_ns_, ended_ns_), ended_ns_);
}

void StampConverter::emptied() noexcept {
  after_ns_ = began_ns_;
  older_offset_ns_ = offset_ns_;
}

std::int64_t HardwareStamps::monotonic_of(std::int64_t hardware_ns,
                                          std::int64_t software_ns) noexcept {
  const std::int64_t distance_ns = software_ns - hardware_ns;
  const std::int64_t known_ns = std::min(least_ns_, least_before_ns_);
  const bool set = known_ns != INT64_MAX && (distance_ns - known_ns > kLongestDelay_ns ||
                                             known_ns - distance_ns > kLongestDelay_ns);
  if (set) least_ns_ = least_before_ns_ = INT64_MAX;
  if (set || known_ns == INT64_MAX || software_ns - bucket_began_ns_ >= kBucket_ns) {
    const bool silence = software_ns - bucket_began_ns_ >= 2 * kBucket_ns;
    least_before_ns_ = silence ? INT64_MAX : least_ns_;
    least_ns_ = INT64_MAX;
    bucket_began_ns_ = software_ns;
  }
  least_ns_ = std::min(least_ns_, distance_ns);
  return hardware_ns + std::min(least_ns_, least_before_ns_);
}

}  // namespace zonepack
