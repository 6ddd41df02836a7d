// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "platform/base/result.hpp"

namespace zonepack {

// How a thread runs. Errors of the calls below: kIo with errno (EPERM: see `zoned run --check`).
struct ThreadSettings {
  const char* name = "";  // at most 15 characters, as ps and top show it
  int fifo_priority = 0;  // SCHED_FIFO 1 to 99; 0: an ordinary thread
  int cpu = -1;           // the only processor it runs on; -1: any
  std::size_t stack_bytes = std::size_t{128} * 1024;  // present before `body` runs
};

// A thread with a stack of a chosen size, all of it present from the start.
//
// Ownership: the destructor joins, so ask the body to end first.
class Thread {
 public:
  Thread() = default;
  // Returns once the thread runs with its settings; after an error there is no thread.
  // allow_ordinary: without the privilege for fifo_priority, the thread runs as an ordinary one and
  // is_realtime() returns false.
  static Result<Thread> start(const ThreadSettings& settings, bool allow_ordinary,
                              std::function<void()> body);
  Thread(Thread&& other) noexcept;
  Thread& operator=(Thread&& other) noexcept;
  ~Thread();

  void join() noexcept;
  // Makes a system call in which the thread waits return EINTR; nothing when it waits in none. By a
  // signal that this class handles (SIGUSR2).
  void interrupt() noexcept;
  bool joinable() const noexcept { return handle_ != 0; }
  bool is_realtime() const noexcept { return realtime_; }

 private:
  unsigned long handle_ = 0;  // pthread_t
  bool realtime_ = false;
};

// Whether the calling thread runs under SCHED_FIFO.
bool thread_is_realtime() noexcept;

// Makes present and locks, of what the process has mapped now, all that a control thread touches:
// memory that can be written to, the program, and the C and mathematics libraries. Other libraries'
// code and constants are not locked, 3 MiB of zoned: such a thread neither allocates nor throws, so
// it calls none of them; the program must be linked with -z now, or it would look up symbols there.
// What is mapped later is not locked.
Result<void> lock_memory_now() noexcept;
void unlock_memory() noexcept;

// Makes all threads use one heap that is never returned or moved, so that locked pages stay where
// they are. The first `present_bytes` are made present at once, which costs less than a fault for
// each page.
void use_one_heap(std::size_t present_bytes) noexcept;

// Gives free memory at the end of that heap back to the system, locked or not; some is kept, so
// that the next small need costs no fault.
void give_back_heap() noexcept;

// Kernel counters of the calling thread.
struct ThreadUsage {
  std::uint64_t minor_faults = 0;
  std::uint64_t major_faults = 0;
  std::uint64_t voluntary_switches = 0;
  std::uint64_t involuntary_switches = 0;
};
ThreadUsage thread_usage() noexcept;

// The peak resident memory of the process (VmHWM); 0 when unknown.
std::uint64_t process_peak_bytes() noexcept;

}  // namespace zonepack
