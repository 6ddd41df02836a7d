// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

enum class Signal : std::uint8_t { kNone, kStop, kReload };

// Blocks SIGTERM and SIGINT (stop) and SIGHUP (reload) until next_signal() asks for them, and
// ignores SIGPIPE.
//
// Threads: call before any other thread starts.
void hold_signals() noexcept;

// The next signal, waiting for one until monotonic_ns() reaches the time.
Signal next_signal(std::int64_t until_monotonic_ns) noexcept;

}  // namespace zonepack
