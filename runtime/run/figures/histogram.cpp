// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/histogram.hpp"

#include <algorithm>
#include <bit>

namespace zonepack {

// Below kPerOctave a bucket holds one value; above, kPerOctave of them share each power of two.
std::size_t Histogram::bucket_of(std::uint64_t ns) noexcept {
  if (ns < kPerOctave) return static_cast<std::size_t>(ns);
  const auto shift = static_cast<std::size_t>(std::bit_width(ns) - std::bit_width(kPerOctave));
  const std::size_t bucket =
      (shift + 1) * kPerOctave + static_cast<std::size_t>(ns >> shift) - kPerOctave;
  return std::min(bucket, kPerOctave * kOctaves - 1);
}

std::int64_t Histogram::upper_end(std::size_t bucket) noexcept {
  if (bucket < kPerOctave) return static_cast<std::int64_t>(bucket);
  const std::size_t shift = bucket / kPerOctave - 1;
  const std::uint64_t first = kPerOctave + bucket % kPerOctave;
  return static_cast<std::int64_t>(((first + 1) << shift) - 1);
}

void Histogram::add(std::int64_t ns) noexcept {
  ns = std::max<std::int64_t>(ns, 0);
  ++counts_[bucket_of(static_cast<std::uint64_t>(ns))];
  ++count_;
  max_ = std::max(max_, ns);
}

std::int64_t Histogram::percentile(double share) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(count_) + 0.5);
  std::uint64_t passed = 0;
  for (std::size_t bucket = 0; bucket < counts_.size(); ++bucket) {
    passed += counts_[bucket];
    if (passed >= wanted && passed > 0) return std::min(upper_end(bucket), max_);
  }
  return max_;
}

TimingFigures Histogram::figures() const noexcept {
  return {count_, percentile(0.5), percentile(0.99), percentile(0.999), percentile(0.9999), max_};
}

}  // namespace zonepack
