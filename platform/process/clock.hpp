// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

// CLOCK_MONOTONIC and CLOCK_REALTIME in nanoseconds.
//
// Real-time: no system call where the kernel offers the vDSO.
std::int64_t monotonic_ns() noexcept;
std::int64_t realtime_ns() noexcept;

// CLOCK_REALTIME minus CLOCK_MONOTONIC, from the least interrupted of up to three readings; the
// error is below half the time that this reading took.
std::int64_t clock_offset_ns() noexcept;

// CPU time of the calling thread.
std::int64_t thread_cpu_ns() noexcept;

// Sleeps until monotonic_ns() reaches the time; returns at once when it has passed. Signals do not
// shorten it.
void sleep_until_ns(std::int64_t monotonic_ns) noexcept;

}  // namespace zonepack
