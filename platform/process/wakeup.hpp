// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

namespace zonepack {

// Wakes one waiting thread from another.
//
// Real-time: post() makes at most one system call and never waits.
// Threads: any.
class Wakeup {
 public:
  Wakeup();
  ~Wakeup();
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  void post() noexcept;
  // Returns once post() has been called since the last return, or monotonic_ns() reaches the time.
  void wait_until(std::int64_t monotonic_ns) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace zonepack
