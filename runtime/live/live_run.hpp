// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "platform/base/failure.hpp"
#include "platform/can/can_log.hpp"
#include "platform/process/notify.hpp"
#include "runtime/live/bus/can_source.hpp"
#include "runtime/live/cycle/end_guard.hpp"
#include "runtime/live/cycle/live_control.hpp"
#include "runtime/live/cycle/live_memory.hpp"
#include "runtime/live/gpio/live_lines.hpp"
#include "runtime/live/live_inputs.hpp"
#include "runtime/live/live_observers.hpp"
#include "runtime/live/map_change.hpp"
#include "runtime/run/inputs/run_inputs.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

struct LiveOptions {
  CanSourceChoice source;
  StartChoice start;
  std::string events;      // file; empty: none
  std::string record_can;  // file; empty: none
  RecordingChoice recording;
  RecordingPreface preface;               // without the start
  std::unique_ptr<HabitKeeper> habits{};  // what the run learns; null: nothing
  BuildInfo build;
  bool quiet = false;  // only warnings and errors on standard error
  bool allow_degraded = false;
};

// A run on the robot's threads:
//
//   inputs ──► control ──► loader            frames, corrections, edges; decisions; packs
//                 │ queues and a status, which control never waits for
//                 └──► observers             event log, recordings, saved state, service; GPIO
//                 lines
//
// Threads: all calls by the main thread, whose signals must be held (platform/process/signals.hpp).
class LiveRun {
 public:
  // All but map and options must outlive this object. The map goes when another replaces it.
  LiveRun(RunInputs& inputs, std::shared_ptr<MapVersion> map, LiveMemory& memory,
          const Notifier& notifier, EndGuard& guard, LiveOptions options);
  ~LiveRun();

  // Reserves and locks memory and starts the threads. When something is refused, nothing runs.
  Outcome<void> start();

  // Until the source ends or a signal asks to stop; one that asks to reload changes to another
  // version of the map.
  void wait();

  // Ends the threads in order, and says how it went. Once, after start(). An output that could not
  // be written is added to `outputs`; the others are completed all the same.
  Outcome<RunSummary> finish(Failures& outputs);

  // Of a log that was played: what was wrong with it.
  const CanLogSummary* log_summary() const { return inputs_.source().log_summary(); }

 private:
  Outcome<void> choose_start();
  Outcome<void> open_control();
  Outcome<void> start_threads();
  ControlSettings control_settings() const;
  RunSummary with_live_figures(RunSummary summary) const;

  RunInputs& files_;
  const Settings& settings_;
  LiveMemory& memory_;
  const Notifier& notifier_;
  EndGuard& guard_;
  LiveOptions options_;
  const std::int64_t period_ns_;
  const std::uint32_t zones_;  // of the first map

  LiveControl control_;
  Run run_;
  LiveObservers observers_;
  LiveLines lines_;
  LiveInputs inputs_;
  std::optional<MapChange> change_;
};

}  // namespace zonepack
