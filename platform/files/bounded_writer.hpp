// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <span>

#include "platform/base/result.hpp"

namespace zonepack {

// Writes to a descriptor that another program handed over and may keep full: a pipe that nobody
// reads, a terminal that is held. It is set to O_NONBLOCK for as long as this object lives; its
// open file description is the other program's too, which can undo that, so the thread must also be
// one that Thread::interrupt() reaches.
//
// Bounds: write() ends within `idle` of the last byte that was taken and within `in_all` of
// construction, and kLook after `cancelled` became true.
// Threads: one; cancelled is set by any.
class BoundedWriter {
 public:
  static constexpr std::chrono::milliseconds kLook{50};

  struct Terms {
    std::chrono::milliseconds idle{10'000};
    std::chrono::milliseconds in_all{120'000};
  };

  // The descriptor and `cancelled` must outlive this object.
  BoundedWriter(int descriptor, const std::atomic<bool>& cancelled, Terms terms) noexcept;
  BoundedWriter(const BoundedWriter&) = delete;
  BoundedWriter& operator=(const BoundedWriter&) = delete;
  ~BoundedWriter();

  // Writes all of the bytes. kIo with errno, ETIMEDOUT for its bounds; kCancelled.
  Result<void> write(std::span<const std::byte> bytes) noexcept;

  int descriptor() const noexcept { return descriptor_; }

 private:
  const int descriptor_;
  const std::atomic<bool>& cancelled_;
  const Terms terms_;
  int flags_;
  std::int64_t began_ns_;  // CLOCK_MONOTONIC
  std::int64_t moved_ns_;  // when the last bytes were taken
};

}  // namespace zonepack
