// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "platform/process/realtime.hpp"

namespace zonepack {

// Runs one piece of work at a time that may take long, on a thread of its own, so that the server
// need not wait for a disk. The destructor waits for the work.
//
// Threads: start() and poll() by one.
class SlowJob {
 public:
  using Work = std::function<Result<std::uint64_t>()>;

  // name: of the thread, at most 15 characters; outlives this object.
  explicit SlowJob(const char* name) : name_(name) {}

  // kBusy while another job runs; kIo when no thread can be started.
  Result<void> start(Work work);

  // The result, once.
  std::optional<Result<std::uint64_t>> poll();

  bool running() const noexcept { return thread_.joinable(); }

  // Waits for the work under way, whose result is lost.
  void join() noexcept { thread_.join(); }

  // Makes a system call in which the work waits return EINTR.
  void interrupt() noexcept { thread_.interrupt(); }

 private:
  const char* name_;
  std::optional<Result<std::uint64_t>> result_;
  std::atomic<bool> done_{false};
  Thread thread_;
};

}  // namespace zonepack
