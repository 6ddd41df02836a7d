// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/end_guard.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "platform/base/last_act.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/signals.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kGuardLook_ns = 50'000'000;
constexpr std::size_t kGuardStackBytes = std::size_t{64} * 1024;

}  // namespace

EndGuard::~EndGuard() {
  done_.store(true);
  thread_.join();
}

void EndGuard::stop_asked() noexcept {
  std::int64_t none = 0;
  until_ns_.compare_exchange_strong(none, monotonic_ns() + kWithin_ns);
  start_thread();
}

void EndGuard::watch() noexcept { start_thread(); }

void EndGuard::start_thread() noexcept {
  if (thread_.joinable()) return;
  auto thread = Thread::start({.name = "zoned-end", .stack_bytes = kGuardStackBytes}, true,
                              [this] { run(); });
  // Without a thread the run ends as it can.
  if (thread) thread_ = std::move(thread).value();
}

void EndGuard::run() noexcept {
  while (!done_.load()) {
    const std::int64_t now_ns = monotonic_ns();
    const std::int64_t until_ns = until_ns_.load();
    if (until_ns != 0 && now_ns >= until_ns) end_process();
    if (until_ns != 0) {
      sleep_until_ns(std::min(now_ns + kGuardLook_ns, until_ns));
    } else if (next_signal(now_ns + kGuardLook_ns) == Signal::kStop) {
      until_ns_.store(monotonic_ns() + kWithin_ns);
    }
  }
}

void EndGuard::end_process() noexcept {
  run_last_act();
  std::error_code ignored;
  for (const std::string& socket : sockets_) {
    if (!socket.empty()) std::filesystem::remove(socket, ignored);
  }
  std::fprintf(stderr,
               "zoned run: ended %d s after it was asked to, without waiting longer for %s; what "
               "that had not written is lost: look at the disk or pipe that it writes to\n",
               static_cast<int>(kWithin_ns / 1'000'000'000), waits_for_.load());
  std::_Exit(1);
}

}  // namespace zonepack
