// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

enum class Signal : std::uint8_t { kNone, kStop, kReload };

// Makes a write beyond the size that a file may have (ulimit -f) an error of that write, EFBIG,
// instead of the process's end. First thing in a program.
void outlive_file_limits() noexcept;

// Blocks SIGTERM and SIGINT (stop) and SIGHUP (reload) until next_signal() asks for them, and
// ignores SIGPIPE.
//
// Threads: call before any other thread starts.
void hold_signals() noexcept;

// The next signal, waiting for one until monotonic_ns() reaches the time.
Signal next_signal(std::int64_t until_monotonic_ns) noexcept;

}  // namespace zonepack
