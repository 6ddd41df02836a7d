// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>

namespace zonepack {

// How often something comes, and how fast a sum grows, over the newest frames and over all.
//
// Memory: the newest kMost samples.
class SignalMeter {
 public:
  static constexpr std::size_t kMost = 64;

  void add(std::int64_t stamp_ns, double sum = 0);

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t last_ns() const noexcept { return newest_.empty() ? 0 : newest_.back().stamp_ns; }
  // Per second. Of the newest it falls while nothing comes.
  double rate_hz(std::int64_t now_ns) const noexcept;
  double mean_rate_hz() const noexcept;
  // Of the sum, over the newest kOver_s.
  double slope_per_s() const noexcept;

 private:
  struct Sample {
    std::int64_t stamp_ns = 0;
    double sum = 0;
  };
  static constexpr double kOver_s = 0.3;  // long against a counter's resolution, short for an eye

  std::deque<Sample> newest_;
  std::int64_t first_ns_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace zonepack
