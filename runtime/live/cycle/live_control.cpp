// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/cycle/live_control.hpp"

#include <cstring>
#include <string>
#include <utility>

namespace zonepack {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) / 1000; }

}  // namespace

Failure privilege_failure(const std::string& what, const Error& error) {
  return failure(what + ": " + std::strerror(static_cast<int>(error.detail)) +
                     "; run as root, give the process CAP_SYS_NICE and CAP_IPC_LOCK (LimitRTPRIO "
                     "and LimitMEMLOCK of its unit), or go on without by --allow-degraded",
                 error.code);
}

void LiveControl::open(const ControlSettings& settings, const ControlPorts& ports) {
  loop_ = std::make_unique<ControlLoop>(settings, ports);
}

Outcome<void> LiveControl::start(bool allow_degraded) {
  allow_degraded_ = allow_degraded;
  const RealtimeSettings& realtime = settings_.realtime;
  const ThreadSettings for_loader{.name = "zoned-loader",
                                  .fifo_priority = static_cast<int>(realtime.loader_priority)};
  if (const auto started = loader.start(for_loader, allow_degraded); !started) {
    return privilege_failure("realtime.loader_priority", started.error());
  }
  const ThreadSettings for_control{.name = "zoned-control",
                                   .fifo_priority = static_cast<int>(realtime.priority),
                                   .cpu = realtime.cpu.empty() ? -1 : std::stoi(realtime.cpu)};
  auto started = Thread::start(for_control, allow_degraded, [this] { control(); });
  if (!started) return privilege_failure("realtime.priority", started.error());
  thread_ = std::move(started).value();
  return {};
}

void LiveControl::control() noexcept {
  // After this thread was made, so that its stack is locked too.
  if (settings_.realtime.lock_memory) {
    const auto locked = lock_memory_now();
    lock_error_.store(locked ? 0 : static_cast<int>(locked.error().detail));
    loop_->set_memory_locked(locked.ok());
  }
  if (lock_error_.load() == 0 || allow_degraded_) loop_->run();
  ended_.store(true);
}

Outcome<void> LiveControl::join() {
  thread_.join();
  const int error = lock_error_.load();
  if (error == 0 || allow_degraded_) return {};
  return failure(std::string("realtime.lock_memory: ") + std::strerror(error) +
                     "; raise LimitMEMLOCK (ulimit -l) above the budget, or go on by "
                     "--allow-degraded",
                 ErrorCode::kIo);
}

LiveFigures LiveControl::figures() const {
  const LiveStatus& last = loop_->last_status();
  const WorstCycle& worst = last.worst;
  LiveFigures live;
  live.minor_faults = last.minor_faults;
  live.major_faults = last.major_faults;
  live.allocations = loop_->allocations();
  live.missed_deadlines = last.overload.missed_deadlines;
  live.cycle_us = timing_us(loop_->work());
  live.wakeup_us = timing_us(loop_->wakeup());
  live.worst = {.cycle = worst.cycle,
                .us = us(worst.ns),
                .step_us = us(worst.step_ns),
                .step = to_string(worst.step),
                .frames = worst.frames,
                .corrections = worst.corrections,
                .loads = worst.loads,
                .commands = worst.commands};
  live.lost_events = last.overload.lost_events;
  live.realtime = thread_.is_realtime();
  live.memory_locked = settings_.realtime.lock_memory && lock_error_.load() == 0;
  return live;
}

LiveFigures::Timing timing_us(const Histogram& histogram) {
  const TimingFigures figures = histogram.figures();
  return {.p50 = us(figures.p50),
          .p99 = us(figures.p99),
          .p999 = us(figures.p999),
          .p9999 = us(figures.p9999),
          .max = us(figures.max)};
}

}  // namespace zonepack
