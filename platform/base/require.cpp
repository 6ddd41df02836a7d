// SPDX-License-Identifier: Apache-2.0
#include "platform/base/require.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "platform/base/last_act.hpp"

namespace zonepack {
namespace {

std::atomic<void (*)() noexcept> last_act{nullptr};

}  // namespace

void set_last_act(void (*act)() noexcept) noexcept { last_act.store(act); }

void run_last_act() noexcept {
  if (const auto act = last_act.exchange(nullptr)) act();
}

void require_failed(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "zonepack: bug: %s does not hold (%s:%d); please report this\n", condition,
               file, line);
  run_last_act();
  std::abort();
}

}  // namespace zonepack
