// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "platform/base/failure.hpp"
#include "platform/memory/seqlock.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/live/cycle/control_loop.hpp"
#include "runtime/live/cycle/live_loader.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// The threads of a live run that must keep time: control, and the loader that it gives work to.
//
// Threads: the members' own contracts; all else belongs to the owner.
class LiveControl {
 public:
  // All of it must outlive this object.
  LiveControl(const Settings& settings, const Catalog& catalog, SharedMap& map)
      : loader(catalog, map, {settings.loading.read, settings.loading.rate_limit}),
        settings_(settings) {}

  // Makes the loop; the ports outlive this object.
  void open(const ControlSettings& settings, const ControlPorts& ports);
  ControlLoop& loop() noexcept { return *loop_; }

  // Starts the loader, then control. allow_degraded: goes on without priorities or locked memory.
  Outcome<void> start(bool allow_degraded);
  bool ended() const noexcept { return ended_.load(); }
  void stop() noexcept {
    if (loop_) loop_->stop();
  }
  // Waits for the end of control. Fails when it never began, because memory could not be locked.
  Outcome<void> join();

  // After join(): what control measured of itself.
  LiveFigures figures() const;

  LiveLoader loader;
  Seqlock<LiveStatus> status;
  OverloadCounters overload;

 private:
  void control() noexcept;

  const Settings& settings_;
  std::unique_ptr<ControlLoop> loop_;
  bool allow_degraded_ = false;
  std::atomic<bool> ended_{false};
  std::atomic<int> lock_error_{0};
  Thread thread_;
};

// In microseconds.
LiveFigures::Timing timing_us(const Histogram& histogram);

// What to do when a thread's priority, stack or memory is refused: `what` names the setting.
Failure privilege_failure(const std::string& what, const Error& error);

}  // namespace zonepack
