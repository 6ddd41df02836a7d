// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/messages/log_thread.hpp"

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kTurn_ns = 2'000'000;

}  // namespace

Result<void> LogThread::start() {
  auto thread = Thread::start({.name = "zoned-log"}, true, [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void LogThread::stop() noexcept {
  stop_.store(true);
  thread_.join();
}

void LogThread::run() {
  for (bool last = false; !last;) {
    last = stop_.load();
    drain();
    for (const auto& task : tasks_) task();
    if (!last) sleep_until_ns(monotonic_ns() + kTurn_ns);
  }
}

// No more than there is room for: tasks must have their turn while a fast log is played.
void LogThread::drain() {
  LiveNote note;
  for (std::size_t left = notes_.capacity(); left > 0 && notes_.pop(note); --left) {
    if (note.kind == LiveNote::Kind::kEvent) {
      run_.on_event(note.event);
    } else {
      run_.after_cycle(note.cycle);
    }
  }
}

}  // namespace zonepack
