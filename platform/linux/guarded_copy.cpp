// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/guarded_copy.hpp"

#include <setjmp.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstring>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

struct Guard {
  sigjmp_buf back;
  std::uintptr_t begin;  // whole pages
  std::uintptr_t end;
};

// initial-exec, because reading it in a handler must not allocate, even in a shared library.
[[gnu::tls_model("initial-exec")]] thread_local Guard* volatile running = nullptr;

struct sigaction former_action;

void on_bus_error(int signal, siginfo_t* info, void* context) {
  const bool sent = info->si_code <= 0;  // raised by kill(), not by a fault
  const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
  if (Guard* const guard = running;
      !sent && guard != nullptr && guard->begin <= at && at < guard->end) {
    siglongjmp(guard->back, 1);
  }
  if ((former_action.sa_flags & SA_SIGINFO) != 0)
    return former_action.sa_sigaction(signal, info, context);
  if (former_action.sa_handler != SIG_DFL && former_action.sa_handler != SIG_IGN) {
    return former_action.sa_handler(signal);
  }
  if (sent && former_action.sa_handler == SIG_IGN) return;
  struct sigaction standard = {};
  standard.sa_handler = SIG_DFL;
  ::sigaction(SIGBUS, &standard, nullptr);
  if (sent) ::raise(SIGBUS);  // a fault recurs by itself
}

bool install() {
  struct sigaction ours = {};
  ours.sa_sigaction = on_bus_error;
  // SA_NODEFER lets the handler raise a sent signal again.
  ours.sa_flags = SA_SIGINFO | SA_NODEFER | SA_ONSTACK;
  sigemptyset(&ours.sa_mask);
  return ::sigaction(SIGBUS, &ours, &former_action) == 0;
}

}  // namespace

[[gnu::noinline]] bool guarded_copy(std::byte* to, const std::byte* from,
                                    std::size_t size) noexcept {
  static const bool installed = install();
  ZP_REQUIRE(installed);
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  Guard guard;
  guard.begin = reinterpret_cast<std::uintptr_t>(from) / page * page;
  guard.end = (reinterpret_cast<std::uintptr_t>(from) + size + page - 1) / page * page;
  // Saves the signal mask: a wrapper of handlers (a sanitizer) may block signals around ours.
  if (sigsetjmp(guard.back, 1) != 0) {
    running = nullptr;
    return false;
  }
  running = &guard;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  std::memcpy(to, from, size);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  running = nullptr;
  return true;
}

}  // namespace zonepack
