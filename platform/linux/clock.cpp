// SPDX-License-Identifier: Apache-2.0
#include "platform/process/clock.hpp"

#include <cerrno>
#include <ctime>

namespace zonepack {
namespace {

std::int64_t read(clockid_t clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

std::int64_t monotonic_ns() noexcept { return read(CLOCK_MONOTONIC); }
std::int64_t realtime_ns() noexcept { return read(CLOCK_REALTIME); }
std::int64_t thread_cpu_ns() noexcept { return read(CLOCK_THREAD_CPUTIME_ID); }

std::int64_t clock_offset_ns() noexcept {
  constexpr std::int64_t kUndisturbed_ns = 2'000;
  std::int64_t best_ns = 0;
  std::int64_t least_ns = INT64_MAX;
  for (int i = 0; i < 3 && least_ns > kUndisturbed_ns; ++i) {
    const std::int64_t before_ns = monotonic_ns();
    const std::int64_t real_ns = realtime_ns();
    const std::int64_t took_ns = monotonic_ns() - before_ns;
    if (took_ns >= least_ns) continue;
    least_ns = took_ns;
    best_ns = real_ns - (before_ns + took_ns / 2);
  }
  return best_ns;
}

void sleep_until_ns(std::int64_t monotonic_ns) noexcept {
  if (monotonic_ns <= 0) return;
  timespec until{};
  until.tv_sec = static_cast<time_t>(monotonic_ns / 1'000'000'000);
  until.tv_nsec = static_cast<long>(monotonic_ns % 1'000'000'000);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace zonepack
