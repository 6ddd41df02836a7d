// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "platform/process/slow_job.hpp"
#include "runtime/live/cycle/control_loop.hpp"
#include "runtime/live/run_recording.hpp"
#include "runtime/live/service.hpp"
#include "runtime/memory/shared_map.hpp"
#include "runtime/run/run.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// What a change of map reaches; all of it outlives the change.
struct MapChangePorts {
  const Settings& settings;
  const SharedMap& shared;
  ControlLoop& loop;
  Run& run;
  RunRecording& recording;
  Service& service;
};

// Changes to another version of the map while the robot drives (SIGHUP): reads the manifest in the
// folder of the map in use, checks it and its packs, and makes its tables, in a thread of its own;
// announces it to the server; offers it to the control thread, which loads the robot's zone and
// switches, or refuses (MapSwitcher); and frees what is no longer used once nobody looks at it.
// Whatever is wrong, the map in use stays, an event says why, and a message names the file.
//
// Memory: never more than MapModel::room_for_next() of the map in use; given back after a refusal.
//
// Threads: one, which calls turn() many times a second.
class MapChange {
 public:
  explicit MapChange(const MapChangePorts& ports) : ports_(ports) {}

  // Asks for a change, which begins when the one under way is over.
  void ask() noexcept { asked_ = true; }
  void turn();
  // Waits for the thread; no change begins or goes on after that.
  void stop() noexcept { job_.join(); }

 private:
  enum class Step : std::uint8_t { kNone, kPreparing, kAnnouncing, kOffered, kFreeing };

  void begin();
  Result<std::uint64_t> prepare(const MapVersion& in_use);
  Outcome<std::shared_ptr<MapVersion>> make_next(const MapVersion& in_use);
  void end_preparing(const Result<std::uint64_t>& prepared);
  void take_unused();

  MapChangePorts ports_;
  bool asked_ = false;
  Step step_ = Step::kNone;
  std::uint32_t in_use_ = 1;          // numbers of maps
  std::uint32_t last_number_ = 1;     // given to a map
  std::shared_ptr<MapVersion> next_;  // the job's while it runs, like the failure
  std::string failure_;
  std::uint32_t leaving_ = 0;
  std::weak_ptr<MapVersion> leaving_map_;
  SlowJob job_{"zoned-map"};
};

}  // namespace zonepack
