// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recorded_run.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "platform/base/require.hpp"
#include "runtime/replay/recorded_loader.hpp"
#include "runtime/run/inputs/run_inputs.hpp"
#include "runtime/run/maps/modelled_loader.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {
namespace {

// The catalog of a map that the run was offered.
Outcome<Catalog> catalog_of(const RecordingReader& recording, const Settings& settings,
                            std::uint32_t number) {
  const std::string which = "map " + std::to_string(number) + ", which the run was offered, ";
  const RecordedMap* const recorded = recording.map(number);
  if (recorded == nullptr) {
    return failure(which + "is not in the recording", ErrorCode::kNotFound);
  }
  auto catalog = Catalog::read(recorded->manifest, recorded->folder, settings.memory.payload.mask);
  if (!catalog) {
    return failure(which + "cannot be used: " + catalog.error().message, catalog.error().code);
  }
  if (auto chosen = catalog->choose_layers(settings.memory.layers); !chosen) return chosen.error();
  return std::move(catalog).value();
}

MapTerms recorded_terms(const RecordingReader& recording, const Settings& settings) {
  MapTerms terms = recording.preface().terms;
  terms.habits = has_habits(settings);
  terms.eviction = settings.memory.eviction;
  if (!terms.habits || !recording.checkpoint()) return terms;
  if (const auto& learned = recording.checkpoint()->transitions; !learned.empty()) {
    auto read = read_transitions(learned);
    if (read) terms.learned = std::make_shared<LearnedTransitions>(std::move(read).value());
  }
  return terms;
}

// Feeds a recording to a run.
class RecordedDrive {
 public:
  RecordedDrive(RecordingReader& recording, const RecordedRun& recorded,
                const std::string& events_path, std::shared_ptr<MapVersion> map,
                RunObserver* observer)
      : recording_(recording),
        settings_(recorded.settings),
        exact_(!recording.checkpoint()),
        recorded_(map->catalog()),
        modelled_(map->catalog(), recording.preface().terms.rates),
        run_({.cycle = cycle_config(settings_),
              .terms = recorded_terms(recording, settings_),
              .events = events_path,
              .keep_trace = true},
             std::move(map)) {
    if (observer != nullptr) run_.add_observer(*observer);
  }

  Outcome<RecordedRunResult> drive();

 private:
  ZoneLoader& loader() { return exact_ ? static_cast<ZoneLoader&>(recorded_) : modelled_; }
  Outcome<void> begin();
  void go_on_from(const Checkpoint& checkpoint);
  Outcome<void> run_cycles();
  Outcome<void> offer(std::uint32_t number);
  Outcome<void> answer(const RecordedInput& input);
  Outcome<void> take_loads(const RecordedInput& input);
  void take_commands(const RecordedInput& input);
  std::span<const LineEdge> take_edges(const RecordedInput& input);
  Outcome<RecordedRunResult> result();

  RecordingReader& recording_;
  const Settings& settings_;
  const bool exact_;
  RecordedLoader recorded_;
  ModelledLoader modelled_;  // from a checkpoint
  Run run_;
  std::vector<LoadResult> loads_;  // of the cycle
  std::vector<Command> commands_;  // of the cycle
  std::vector<Command> waiting_;   // for the cycles to come
  std::vector<LineEdge> edges_;    // of the cycle
  bool held_ = false;              // by the checkpoint, until the first cycle
  std::uint64_t frames_ = 0;
};

Outcome<void> RecordedDrive::begin() {
  if (exact_) {
    if (const auto& start = recording_.preface().start) run_.start_at(*start);
    return {};
  }
  const Checkpoint& checkpoint = *recording_.checkpoint();
  go_on_from(checkpoint);
  if (checkpoint.offered_map == 0) return {};
  return offer(checkpoint.offered_map);
}

void RecordedDrive::go_on_from(const Checkpoint& checkpoint) {
  const MapInUse& map = run_.switcher().map();
  for (const Checkpoint::Held& held : checkpoint.resident) {
    if (held.zone >= map.needs.size()) continue;
    if (map.memory.restore(held.zone, map.needs[held.zone], held.generation)) {
      run_.statistics().begin_with(held.zone);
    }
  }
  Cycle& cycle = map.cycle;
  cycle.continue_from(checkpoint.cycle, checkpoint.start_ns);
  if (checkpoint.lost) cycle.continue_lost(checkpoint.sought);
  if (checkpoint.has_pose) {
    cycle.start_at(checkpoint.now_ns, checkpoint.T_map_base,
                   std::max(checkpoint.sigma_m, settings_.pose.start_sigma_m),
                   std::max(checkpoint.sigma_rad, settings_.pose.start_sigma_rad));
  }
  const auto add = [&](Command::Kind kind, ZoneId zone) {
    Command& command = waiting_.emplace_back();
    command.kind = kind;
    command.zone = zone;
  };
  held_ = checkpoint.held;
  if (checkpoint.frozen) add(Command::Kind::kFreeze, kNoZone);
  if (!checkpoint.route.empty()) {
    add(Command::Kind::kRouteHint, kNoZone);
    Command& hint = waiting_.back();
    hint.route_length =
        static_cast<std::uint32_t>(std::min(checkpoint.route.size(), Command::kMostRoute));
    std::copy_n(checkpoint.route.begin(), hint.route_length, hint.route.begin());
  }
  for (const ZoneId zone : checkpoint.pinned) add(Command::Kind::kPin, zone);
}

Outcome<void> RecordedDrive::answer(const RecordedInput& input) {
  for (const LoadResult& load : input.loads) {
    const std::optional<LoadRequest> asked = recorded_.asked();
    if (recorded_.answer(load)) continue;
    const auto text = [&](ZoneId zone, std::uint32_t generation) {
      const ZoneGraph& graph = run_.accounted_map().model().graph;
      const std::string name =
          zone < graph.zone_count() ? graph.name(zone) : "number " + std::to_string(zone);
      return "zone " + name + " (generation " + std::to_string(generation) + ")";
    };
    return failure(
        "diverged at cycle " + std::to_string(run_.switcher().map().cycle.state().cycles) +
            ": recorded is what became of a load of " + text(load.zone, load.generation) +
            ", but here " + (asked ? text(asked->zone, asked->generation) : std::string("none")) +
            " was asked for; replay with the version that recorded it, " +
            recording_.preface().program,
        ErrorCode::kMismatch);
  }
  return {};
}

// What became of loads: as recorded, or as modelled.
Outcome<void> RecordedDrive::take_loads(const RecordedInput& input) {
  loads_.clear();
  if (exact_) {
    loads_ = input.loads;
    return answer(input);
  }
  modelled_.advance_to(input.now_ns);
  while (const auto load = modelled_.poll()) loads_.push_back(*load);
  return {};
}

// The commands of the cycle, behind those of a checkpoint that do not fit in one.
void RecordedDrive::take_commands(const RecordedInput& input) {
  waiting_.insert(waiting_.end(), input.commands.begin(), input.commands.end());
  const auto end = waiting_.begin() +
                   static_cast<std::ptrdiff_t>(std::min(waiting_.size(), Cycle::kMostCommands));
  commands_.assign(waiting_.begin(), end);
  waiting_.erase(waiting_.begin(), end);
}

std::span<const LineEdge> RecordedDrive::take_edges(const RecordedInput& input) {
  edges_.clear();
  if (held_) edges_.push_back({input.now_ns, LineEdge::kHold, true});
  held_ = false;
  edges_.insert(edges_.end(), input.edges.begin(), input.edges.end());
  return edges_;
}

Outcome<void> RecordedDrive::run_cycles() {
  while (const RecordedInput* const recorded = recording_.next()) {
    if (auto taken = take_loads(*recorded); !taken) return taken;
    take_commands(*recorded);
    if (recorded->offer.map != 0) {
      if (auto offered = offer(recorded->offer.map); !offered) return offered;
    }
    run_.step({.now_ns = recorded->now_ns,
               .frames = recorded->frames,
               .corrections = recorded->corrections,
               .loads = loads_,
               .commands = commands_,
               .offer = recorded->offer,
               .edges = take_edges(*recorded)});
    frames_ += recorded->frames.size();
  }
  return {};
}

Outcome<void> RecordedDrive::offer(std::uint32_t number) {
  if (run_.find(number) != nullptr || run_.switcher().changing()) {
    return failure("map " + std::to_string(number) + " was offered while another was",
                   ErrorCode::kMismatch);
  }
  auto catalog = catalog_of(recording_, settings_, number);
  if (!catalog) return catalog.error();
  auto map = run_.prepare(number, std::move(*catalog));
  if (!map) return map.error();
  run_.add(*map);
  ZP_REQUIRE(run_.switcher().offer((*map)->in_use()));
  return {};
}

Outcome<RecordedRunResult> RecordedDrive::drive() {
  if (const auto opened = run_.open({.loader = loader()}); !opened) return opened.error();
  if (const auto begun = begin(); !begun) return begun.error();
  if (const auto driven = run_cycles(); !driven) return driven.error();
  run_.end();
  return result();
}

Outcome<RecordedRunResult> RecordedDrive::result() {
  const ByteCount bytes = exact_ ? recorded_.bytes_loaded() : modelled_.bytes_loaded();
  RecordedRunResult result;
  result.replay.summary = run_.summarise(bytes, frames_);
  result.replay.events_written = run_.close_events();
  result.replay.trace = run_.take_trace();
  result.first_cycle = recording_.first_cycle();
  result.next_cycle = recording_.cycles_read();
  result.complete = recording_.complete();
  result.exact = exact_;
  if (recording_.end()) result.live_hash = recording_.end()->event_log_hash;
  return result;
}

}  // namespace

Outcome<RecordedRun> open_recorded_run(const RecordingPreface& preface) {
  LoadedSettings loaded = parse_settings(preface.settings, preface.settings_path, preface.dbc);
  if (!loaded.ok()) {
    std::string all = "the recorded settings cannot be used by this version (recorded by " +
                      preface.program + ")";
    for (const std::string& fault : loaded.faults) all += "\n  " + fault;
    return failure(std::move(all));
  }
  auto catalog =
      Catalog::read(preface.manifest, preface.map_folder, loaded.settings.memory.payload.mask);
  if (!catalog) {
    return failure("the recorded map cannot be used: " + catalog.error().message,
                   catalog.error().code);
  }
  if (auto chosen = catalog->choose_layers(loaded.settings.memory.layers); !chosen) {
    return chosen.error();
  }
  return RecordedRun{std::move(loaded.settings), std::move(catalog).value()};
}

Outcome<RecordedRunResult> replay_recording(RecordingReader& recording, const RecordedRun& run,
                                            const std::string& events_path, RunObserver* observer) {
  const MapTerms terms = recorded_terms(recording, run.settings);
  auto map = MapVersion::make(1, run.catalog, terms);
  if (!map) return map.error();
  const std::uint32_t in_use = recording.checkpoint() ? recording.checkpoint()->map : 1;
  if (in_use != 1) {
    auto catalog = catalog_of(recording, run.settings, in_use);
    if (!catalog) return catalog.error();
    map = MapVersion::make(in_use, std::move(*catalog), (*map)->model().terms_of_next(terms));
    if (!map) return map.error();
  }
  return RecordedDrive(recording, run, events_path, std::move(*map), observer).drive();
}

}  // namespace zonepack
