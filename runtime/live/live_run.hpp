// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "platform/can_log.hpp"
#include "platform/notify.hpp"
#include "runtime/live/can_source.hpp"
#include "runtime/live/live_memory.hpp"
#include "runtime/live/run_recording.hpp"
#include "runtime/run/map_version.hpp"
#include "runtime/run/run_inputs.hpp"
#include "runtime/run/run_summary.hpp"

namespace zonepack {

struct LiveOptions {
  CanSourceChoice source;
  StartChoice start;
  std::string events;      // file; empty: none
  std::string record_can;  // file; empty: none
  RecorderChoice recorder;
  RecordingPreface preface;  // but for the start
  bool allow_degraded = false;
};

// A run of the robot's threads: control, loader, log thread, and what feeds them.
//
// Threads: all calls by the main thread, whose signals must be held (platform/signals.hpp).
class LiveRun {
 public:
  // All but map and options must outlive this object. The map goes when another takes its place.
  LiveRun(RunInputs& inputs, std::shared_ptr<MapVersion> map, LiveMemory& memory,
          const Notifier& notifier, const LiveOptions& options);
  ~LiveRun();

  // Reserves and locks memory and starts the threads. False when something is refused; `fault`
  // says what in a complete message, and nothing runs.
  bool start(std::string& fault);

  // Until the source ends or a signal asks to stop; one that asks to reload takes another version
  // of the map.
  void wait();

  // Ends the threads in order, and says how it went. Once, after start(); nothing with a complete
  // message in `fault` when results could not be written.
  std::optional<RunSummary> finish(std::string& fault);

  // Of a log that was played: what was wrong with it.
  const CanLogSummary* log_summary() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace zonepack
