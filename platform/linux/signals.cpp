// SPDX-License-Identifier: Apache-2.0
#include "platform/process/signals.hpp"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <ctime>

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

sigset_t held() noexcept {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, number);
  return set;
}

}  // namespace

void hold_signals() noexcept {
  const sigset_t set = held();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

void outlive_file_limits() noexcept { signal(SIGXFSZ, SIG_IGN); }

Signal next_signal(std::int64_t until_monotonic_ns) noexcept {
  const sigset_t set = held();
  const std::int64_t wait_ns = std::max<std::int64_t>(until_monotonic_ns - monotonic_ns(), 0);
  timespec wait{};
  wait.tv_sec = static_cast<time_t>(wait_ns / 1'000'000'000);
  wait.tv_nsec = static_cast<long>(wait_ns % 1'000'000'000);
  switch (sigtimedwait(&set, nullptr, &wait)) {
    case SIGTERM:
    case SIGINT:
      return Signal::kStop;
    case SIGHUP:
      return Signal::kReload;
    default:
      return Signal::kNone;
  }
}

}  // namespace zonepack
