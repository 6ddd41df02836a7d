// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/control/map_switcher.hpp"
#include "runtime/run/event_log.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/run/figures/run_trace.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/inputs/run_start.hpp"
#include "runtime/run/maps/map_registry.hpp"
#include "runtime/run/maps/map_version.hpp"
#include "runtime/run/run_statistics.hpp"

namespace zonepack {

struct RunPlan {
  CycleConfig cycle{};
  MapTerms terms{};                   // on which the first map is held; the next get no more
  const TruthTrack* truth = nullptr;  // for the statistics; outlives the run
  std::string events{};               // file of the event log; empty: none
  bool keep_trace = false;            // for drawing; grows with the run
  EvictionOrderMaker eviction{};      // nothing: least recently used
};

// What a run works with; all of it outlives the run.
struct RunPorts {
  ZoneLoader& loader;
  // Takes the cycle's events, and passes them to Run::on_event() later; null: the run takes them at
  // once.
  EventSink* queue = nullptr;
  ZoneDirectory* directory = nullptr;  // where readers find resident zones
};

// Sees the events of a run in their order, each with the map that it is about, and what each cycle
// did. Cycles may be missing where the account did not keep up.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void on_event(const Event& event, const MapVersion& map) noexcept = 0;
  virtual void after_cycle(const CycleRecord& /*cycle*/, const MapVersion& /*map*/) noexcept {}
};

// One run: its maps, the cycle over the one in use, its event log and its statistics. A live run,
// the replay of a log and the replay of a recording are each this one object; they differ in where
// inputs, loads and time come from, and in what lies between the cycle and the account:
//
//   inputs ─► switcher().run() ─► events ─► (a queue, when live) ─► on_event(), after_cycle()
//             └ the cycle: pose, zone, memory, loads                └ statistics, event log,
//             observers
//
// Threads: switcher(), start_at() and step() belong to control; on_event() and after_cycle() to the
// account, the same thread or another; prepare(), add(), find() and remove() are for any; the rest
// is for one thread while no other is in the run.
class Run final : public EventSink {
 public:
  // `first` was made on the plan's terms, as number 1 unless the run goes on from a checkpoint.
  Run(RunPlan plan, std::shared_ptr<MapVersion> first);

  // Opens the event log and prepares the first map. Once, before everything below.
  Outcome<void> open(const RunPorts& ports);

  // Must outlive the run. Before the first event.
  void add_observer(RunObserver& observer) { observers_.push_back(&observer); }

  void start_at(const RunStart& start);

  // ---- Control: one cycle.
  MapSwitcher& switcher() noexcept { return *switcher_; }
  // Runs a cycle and accounts for it at once: for a run whose events pass no queue.
  void step(const CycleInput& input);

  // ---- Maps.
  // A version that may take the place of the one in use, on terms that ask for no more of anything.
  Outcome<std::shared_ptr<MapVersion>> prepare(std::uint32_t number, Catalog catalog) const;
  void add(std::shared_ptr<MapVersion> map) { maps_.add(std::move(map)); }
  std::shared_ptr<MapVersion> find(std::uint32_t number) const { return maps_.find(number); }
  std::weak_ptr<MapVersion> remove(std::uint32_t number) { return maps_.remove(number); }

  // ---- Account.
  void on_event(const Event& event) noexcept override;
  void after_cycle(const CycleRecord& cycle);
  // The map that the account has reached.
  const MapVersion& accounted_map() const noexcept { return *accounted_; }
  RunStatistics& statistics() noexcept { return statistics_; }

  // ---- The end.
  // Records the end of the run as an event. Control.
  void end() noexcept { switcher_->map().cycle.finish(); }
  // After the account has taken the last event.
  RunSummary summarise(ByteCount bytes_loaded, std::uint64_t can_frames) const;
  // Completes the event log's file; fails when it could not be written.
  Outcome<void> close_events();
  // With the plan's keep_trace; once.
  RunTrace take_trace();

 private:
  Outcome<void> prepare(MapVersion& map) const;
  void follow(std::uint32_t map) noexcept;

  RunPlan plan_;
  MapTerms terms_of_next_;
  std::shared_ptr<MapVersion> first_;  // drawings stay on its ground
  MapRegistry maps_;
  std::optional<RunPorts> ports_;
  std::optional<MapSwitcher> switcher_;
  std::shared_ptr<const MapVersion> accounted_;
  EventLog log_;
  RunStatistics statistics_;
  std::vector<RunObserver*> observers_;
};

}  // namespace zonepack
