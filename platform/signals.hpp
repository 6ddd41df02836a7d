// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

enum class Signal : std::uint8_t { kNone, kStop, kReload };

// Keeps SIGTERM and SIGINT (stop) and SIGHUP (reload) from interrupting anybody: they wait to be
// asked for. SIGPIPE is ignored. Call before any thread is started.
void hold_signals() noexcept;

// The next signal that came, waiting for one until monotonic_ns() reaches the time.
Signal next_signal(std::int64_t until_monotonic_ns) noexcept;

}  // namespace zonepack
