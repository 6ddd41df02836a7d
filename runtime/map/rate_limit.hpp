// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack {

// A token bucket for reading: in any interval of length t at most rate * t + burst bytes, plus the
// one window that emptied the bucket. Pure arithmetic; the caller keeps the clock and sleeps.
//
// Threads: one owner. No allocation.
class RateLimit {
 public:
  // bytes_per_s 0: no limit.
  explicit RateLimit(std::uint64_t bytes_per_s, ByteCount burst = kReadBufferBytes) noexcept;

  // Counts what was read up to now_ns, a monotonic time; returns for how many nanoseconds to read
  // nothing.
  std::int64_t spend(ByteCount bytes, std::int64_t now_ns) noexcept;

 private:
  std::uint64_t bytes_per_s_;
  std::int64_t burst_ns_;             // to fill the bucket
  std::int64_t paid_ns_ = INT64_MIN;  // when everything read so far is paid for
};

}  // namespace zonepack
