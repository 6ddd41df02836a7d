// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace zonepack {

// How many lines may be printed: kBurst at once, then kPerSecond. What comes faster is counted.
//
// Threads: one.
class LineAllowance {
 public:
  static constexpr std::int64_t kBurst = 200;
  static constexpr std::int64_t kPerSecond = 20;

  // Whether a line may be printed at now_ns of a clock that does not step back.
  bool take(std::int64_t now_ns) noexcept {
    constexpr std::int64_t kLine_ns = 1'000'000'000 / kPerSecond;
    // full_at_ns_ is when the whole burst would be there again.
    full_at_ns_ = std::max(full_at_ns_, now_ns);
    if (full_at_ns_ - now_ns > (kBurst - 1) * kLine_ns) return false;
    full_at_ns_ += kLine_ns;
    return true;
  }

 private:
  std::int64_t full_at_ns_ = 0;
};

}  // namespace zonepack
