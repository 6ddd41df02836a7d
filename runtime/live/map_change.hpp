// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "platform/slow_job.hpp"
#include "runtime/live/control_loop.hpp"
#include "runtime/live/live_loader.hpp"
#include "runtime/live/map_registry.hpp"
#include "runtime/live/run_recording.hpp"
#include "runtime/live/service.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// What a change of map reaches; all of it outlives the change.
struct MapChangePorts {
  const Settings& settings;
  MapTerms terms;  // on which another version may be held
  SharedMap& shared;
  ReadMode read;
  LiveLoader& loader;
  EventSink& events;
  ControlLoop& loop;
  MapRegistry& maps;
  RunRecording& recording;
  Service& service;
  std::function<void(const std::string& message)> tell;
};

// Takes another version of the map while the robot drives (SIGHUP): reads the manifest in the
// folder of the map in use, checks it and its packs, and makes its tables, in a thread of its own;
// tells the server; offers it to the control thread, which loads the robot's zone and switches, or
// refuses (MapSwitcher); and frees what is not used any more once nobody looks at it. Whatever is
// wrong, the map in use stays, an event says why, and a message names the file.
//
// Threads: one, which calls turn() many times a second.
class MapChange {
 public:
  explicit MapChange(MapChangePorts ports) : ports_(std::move(ports)) {}

  // Wishes for a change: begun when the one under way is over.
  void ask() noexcept { asked_ = true; }
  void turn();

 private:
  enum class Step : std::uint8_t { kNone, kPreparing, kTelling, kOffered, kFreeing };

  void begin();
  Result<std::uint64_t> prepare(const MapVersion& in_use);
  void end_preparing(const Result<std::uint64_t>& prepared);
  void take_unused();

  MapChangePorts ports_;
  bool asked_ = false;
  Step step_ = Step::kNone;
  std::uint32_t in_use_ = 1;          // numbers of maps
  std::uint32_t last_number_ = 1;     // given to a map
  std::shared_ptr<MapVersion> next_;  // the job's while it runs, like the message
  std::string fault_;
  std::uint32_t leaving_ = 0;
  std::weak_ptr<MapVersion> leaving_map_;
  SlowJob job_{"zoned-map"};
};

}  // namespace zonepack
