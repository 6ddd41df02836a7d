// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/process/realtime.hpp"

namespace zonepack {

// Ends the process when the end of a run takes too long: a thread that hangs in a call on a disk, a
// pipe or a network drive holds nothing else up for longer than kWithin_ns after the signal to
// stop. Then outputs are put into their safe state, the sockets' names are removed, the process
// says what it waited for and exits with 1; the kernel gives back locks and memory.
//
// Threads: one of its own once the run is ending; all calls by the main thread.
class EndGuard {
 public:
  // Below TimeoutStopSec of config/zoned.service.
  static constexpr std::int64_t kWithin_ns = 6'000'000'000;

  // sockets: names to remove; empty ones are passed over.
  explicit EndGuard(std::vector<std::string> sockets) : sockets_(std::move(sockets)) {}
  ~EndGuard();

  // A signal asked to stop: the time starts. Later calls change nothing.
  void stop_asked() noexcept;
  // The run ends, asked to or not: from here on a signal to stop starts the time.
  void watch() noexcept;
  // What the main thread waits for next: a noun phrase that outlives this object.
  void waits_for(const char* what) noexcept { waits_for_.store(what); }

 private:
  void start_thread() noexcept;
  void run() noexcept;
  [[noreturn]] void end_process() noexcept;

  const std::vector<std::string> sockets_;
  std::atomic<const char*> waits_for_{"the control thread"};
  std::atomic<std::int64_t> until_ns_{0};  // CLOCK_MONOTONIC; 0: not asked to stop
  std::atomic<bool> done_{false};
  Thread thread_;
};

}  // namespace zonepack
