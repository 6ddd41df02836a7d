// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recorded_run.hpp"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/base/require.hpp"
#include "runtime/control/map_switcher.hpp"
#include "runtime/replay/recorded_loader.hpp"
#include "runtime/replay/timed_loader.hpp"
#include "runtime/run/event_log.hpp"
#include "runtime/run/map_version.hpp"
#include "runtime/run/run_inputs.hpp"
#include "runtime/run/run_result.hpp"
#include "runtime/run/run_statistics.hpp"

namespace zonepack {
namespace {

// A map that the run was offered.
std::shared_ptr<MapVersion> map_of(const RecordingReader& recording, const Settings& settings,
                                   const MapTerms& terms, std::uint32_t number,
                                   std::string& fault) {
  const std::string which = "map " + std::to_string(number) + ", which the run was offered, ";
  const RecordedMap* const recorded = recording.map(number);
  if (recorded == nullptr) {
    fault = which + "is not in the recording";
    return nullptr;
  }
  auto catalog = Catalog::read(recorded->manifest, recorded->folder, settings.memory.payload.mask);
  if (!catalog) {
    fault = which + "cannot be used: " + to_string(catalog.error().code);
    return nullptr;
  }
  return MapVersion::make(number, std::move(catalog).value(), terms, fault);
}

// All that one run needs, in the order in which the parts refer to each other.
class RecordedDrive final : public EventSink {
 public:
  RecordedDrive(RecordingReader& recording, const RecordedRun& run, std::shared_ptr<MapVersion> map)
      : recording_(recording),
        settings_(run.settings),
        terms_(map->model().terms_of_next(recording.preface().terms)),
        exact_(!recording.checkpoint()),
        first_(map),
        maps_in_use_{map},
        recorded_(map->catalog()),
        timed_(map->model().work, terms_.rates),
        follower_(
            map, [this](std::uint32_t number) { return find(number); },
            [this](const MapVersion& next) {
              recorder_.change_map(next.model().graph, next.model().needs, next.model().limits);
            }),
        log_([this](ZoneId zone) {
          return std::string_view(follower_.map().model().graph.name(zone));
        }),
        recorder_(map->model().graph, map->model().needs, nullptr, terms_.period_ns,
                  map->model().limits, log_) {
    recorder_.keep_trace();
  }

  void on_event(const Event& event) noexcept override {
    follower_.follow(event.map);
    recorder_.on_event(event);
  }

  std::optional<RecordedRunResult> drive(const std::string& events_path, std::string& fault);

 private:
  ZoneLoader& loader() { return exact_ ? static_cast<ZoneLoader&>(recorded_) : timed_; }
  MapVersion& first() { return *first_; }
  std::shared_ptr<MapVersion> find(std::uint32_t number) const;
  bool prepare(MapVersion& map, std::string& fault);
  bool begin_with(const MapVersion& map, std::string& fault);
  void begin();
  void go_on_from(const Checkpoint& checkpoint);
  bool run_cycles(std::string& fault);
  bool offer(std::uint32_t number, std::string& fault);
  bool answers(const RecordedInput& input, std::string& fault);
  bool take_loads(const RecordedInput& input, std::string& fault);
  void take_commands(const RecordedInput& input);
  std::span<const LineEdge> take_edges(const RecordedInput& input);
  std::optional<RecordedRunResult> result(const std::string& events_path, std::string& fault);

  RecordingReader& recording_;
  const Settings& settings_;
  const MapTerms terms_;  // of maps that the run is offered
  const bool exact_;
  const std::shared_ptr<MapVersion> first_;               // drawings stay on its ground
  std::vector<std::shared_ptr<MapVersion>> maps_in_use_;  // in use, on offer
  RecordedLoader recorded_;
  TimedLoader timed_;  // from a checkpoint
  MapFollower follower_;
  EventLog log_;
  RunStatistics recorder_;
  std::optional<MapSwitcher> maps_;
  std::vector<LoadResult> loads_;  // of the cycle
  std::vector<Command> commands_;  // of the cycle
  std::vector<Command> waiting_;   // for the cycles to come
  std::vector<LineEdge> edges_;    // of the cycle
  bool held_ = false;              // by the checkpoint, until the first cycle
  std::uint64_t frames_ = 0;
};

std::shared_ptr<MapVersion> RecordedDrive::find(std::uint32_t number) const {
  const auto found = std::ranges::find(maps_in_use_, number, &MapVersion::number);
  return found == maps_in_use_.end() ? nullptr : *found;
}

bool RecordedDrive::prepare(MapVersion& map, std::string& fault) {
  return map.prepare(cycle_config(settings_), loader(), *this, nullptr, fault);
}

void RecordedDrive::begin() {
  const std::optional<RecordedStart>& start = recording_.preface().start;
  if (!start) return;
  if (start->sigma_m && start->sigma_rad) {
    first().cycle().start_at(start->now_ns, start->T_map_base, *start->sigma_m, *start->sigma_rad);
  } else {
    first().cycle().start_at(start->now_ns, start->T_map_base);
  }
}

void RecordedDrive::go_on_from(const Checkpoint& checkpoint) {
  for (const Checkpoint::Held& held : checkpoint.resident) {
    const std::vector<ZoneNeed>& needs = first().model().needs;
    if (held.zone >= needs.size()) continue;
    if (first().memory().restore(held.zone, needs[held.zone], held.generation)) {
      recorder_.begin_with(held.zone);
    }
  }
  Cycle& cycle = first().cycle();
  cycle.continue_from(checkpoint.cycle, checkpoint.start_ns);
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

bool RecordedDrive::answers(const RecordedInput& input, std::string& fault) {
  for (const LoadResult& load : input.loads) {
    const std::optional<LoadRequest> asked = recorded_.asked();
    if (recorded_.answer(load)) continue;
    const auto told = [&](ZoneId zone, std::uint32_t generation) {
      const ZoneGraph& graph = follower_.map().model().graph;
      const std::string name =
          zone < graph.zone_count() ? graph.name(zone) : "number " + std::to_string(zone);
      return "zone " + name + " (generation " + std::to_string(generation) + ")";
    };
    fault = "diverged at cycle " + std::to_string(maps_->map().cycle.state().cycles) +
            ": recorded is what became of a load of " + told(load.zone, load.generation) +
            ", but here " + (asked ? told(asked->zone, asked->generation) : std::string("none")) +
            " was asked for; replay with the version that recorded it, " +
            recording_.preface().program;
    return false;
  }
  return true;
}

// What became of loads: as recorded, or as modelled.
bool RecordedDrive::take_loads(const RecordedInput& input, std::string& fault) {
  loads_.clear();
  if (exact_) {
    loads_ = input.loads;
    if (!answers(input, fault)) return false;
  } else {
    timed_.advance_to(input.now_ns);
    while (const auto load = timed_.poll()) loads_.push_back(*load);
  }
  return true;
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

bool RecordedDrive::run_cycles(std::string& fault) {
  while (const RecordedInput* const recorded = recording_.next()) {
    if (!take_loads(*recorded, fault)) return false;
    take_commands(*recorded);
    if (recorded->offer.map != 0 && !offer(recorded->offer.map, fault)) return false;
    maps_->run({recorded->now_ns, recorded->frames, recorded->corrections, loads_, commands_,
                recorded->offer, take_edges(*recorded)});
    frames_ += recorded->frames.size();
    const MapInUse& map = maps_->map();
    follower_.follow(map.number);
    recorder_.after_cycle(record_of(recorded->now_ns, map.cycle.state(), map.memory));
    if (const MapInUse* const unused = maps_->take_unused()) {
      std::erase_if(maps_in_use_, [&](const auto& kept) { return &kept->in_use() == unused; });
    }
  }
  return true;
}

bool RecordedDrive::offer(std::uint32_t number, std::string& fault) {
  if (find(number) != nullptr || maps_->changing()) {
    fault = "map " + std::to_string(number) + " was offered while another was";
    return false;
  }
  auto map = map_of(recording_, settings_, terms_, number, fault);
  if (map == nullptr || !prepare(*map, fault)) return false;
  maps_in_use_.push_back(map);
  ZP_REQUIRE(maps_->offer(map->in_use()));
  return true;
}

std::optional<RecordedRunResult> RecordedDrive::drive(const std::string& events_path,
                                                      std::string& fault) {
  if (!events_path.empty()) {
    if (const auto opened = log_.write_to(events_path); !opened) {
      fault = events_path + ": cannot be written: " + to_string(opened.error().code);
      return std::nullopt;
    }
  }
  if (!prepare(first(), fault)) return std::nullopt;
  maps_.emplace(first().in_use(), loader(), nullptr);
  if (exact_) {
    begin();
  } else {
    go_on_from(*recording_.checkpoint());
  }
  const std::uint32_t on_offer = exact_ ? 0 : recording_.checkpoint()->offered_map;
  if (on_offer != 0 && !offer(on_offer, fault)) return std::nullopt;
  if (!run_cycles(fault)) return std::nullopt;
  maps_->map().cycle.finish();
  return result(events_path, fault);
}

std::optional<RecordedRunResult> RecordedDrive::result(const std::string& events_path,
                                                       std::string& fault) {
  auto hash = log_.finish();
  if (!hash) {
    fault = events_path + ": cannot be written: " + to_string(hash.error().code);
    return std::nullopt;
  }
  RecordedRunResult result;
  RunSummary& summary = result.replay.summary;
  recorder_.summarise(summary);
  summarise_cycle(maps_->map().cycle, summary);
  summary.bytes_loaded = exact_ ? recorded_.bytes_loaded() : timed_.bytes_loaded();
  summary.can_frames = frames_;
  summary.event_log_hash = std::move(hash).value();
  result.replay.trace = recorder_.take_trace();
  describe_map(first().model(), result.replay.trace);
  result.first_cycle = recording_.first_cycle();
  result.next_cycle = recording_.cycles_read();
  result.complete = recording_.complete();
  result.exact = exact_;
  if (recording_.end()) result.live_hash = recording_.end()->event_log_hash;
  return result;
}

}  // namespace

std::optional<RecordedRun> open_recorded_run(const RecordingPreface& preface, std::string& fault) {
  LoadedSettings loaded = parse_settings(preface.settings, preface.settings_path, preface.dbc);
  if (!loaded.ok()) {
    fault = "the recorded settings cannot be used by this version (recorded by " + preface.program +
            ")";
    for (const std::string& text : loaded.faults) fault += "\n  " + text;
    return std::nullopt;
  }
  Result<Catalog> catalog =
      Catalog::read(preface.manifest, preface.map_folder, loaded.settings.memory.payload.mask);
  if (!catalog) {
    fault = "the recorded map cannot be used: " + std::string(to_string(catalog.error().code)) +
            " (" + std::to_string(catalog.error().detail) + ")";
    return std::nullopt;
  }
  return RecordedRun{std::move(loaded.settings), std::move(catalog).value()};
}

std::optional<RecordedRunResult> replay_recording(RecordingReader& recording,
                                                  const RecordedRun& run,
                                                  const std::string& events_path,
                                                  std::string& fault) {
  const RecordingPreface& preface = recording.preface();
  std::shared_ptr<MapVersion> map = MapVersion::make(1, run.catalog, preface.terms, fault);
  if (map == nullptr) return std::nullopt;
  const std::uint32_t in_use = recording.checkpoint() ? recording.checkpoint()->map : 1;
  if (in_use != 1) {
    map = map_of(recording, run.settings, map->model().terms_of_next(preface.terms), in_use, fault);
    if (map == nullptr) return std::nullopt;
  }
  return RecordedDrive(recording, run, std::move(map)).drive(events_path, fault);
}

}  // namespace zonepack
