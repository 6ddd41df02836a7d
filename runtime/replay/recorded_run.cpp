// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recorded_run.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/event_log.hpp"
#include "runtime/replay/driven_map.hpp"
#include "runtime/replay/recorded_loader.hpp"
#include "runtime/replay/run_inputs.hpp"
#include "runtime/replay/run_recorder.hpp"
#include "runtime/replay/run_result.hpp"
#include "runtime/replay/timed_loader.hpp"

namespace zonepack {
namespace {

// All that one run needs, in the order in which the parts refer to each other.
class Run {
 public:
  Run(RecordingReader& recording, const RecordedRun& run, const DrivenMap& map)
      : recording_(recording),
        map_(map),
        guess_(run.settings.pose),
        exact_(!recording.checkpoint()),
        memory_(map.needs.size(), map.limits),
        timed_(map.work, recording.preface().terms.rates),
        log_([this](ZoneId zone) { return std::string_view(map_.graph.name(zone)); }),
        recorder_(map.graph, map.needs, nullptr, recording.preface().terms.period_ns, map.limits,
                  log_),
        cycle_(cycle_config(run.settings),
               {map.graph, map.needs, map.load_s, map.pinned, memory_, loader(), recorder_}) {
    recorder_.keep_trace();
  }

  std::optional<RecordedRunResult> drive(const std::string& events_path, std::string& fault);

 private:
  ZoneLoader& loader() { return exact_ ? static_cast<ZoneLoader&>(recorded_) : timed_; }
  void begin();
  void go_on_from(const Checkpoint& checkpoint);
  bool run_cycles(std::string& fault);
  bool answers(const RecordedInput& input, std::string& fault);
  bool take_loads(const RecordedInput& input, std::string& fault);
  void take_commands(const RecordedInput& input);
  std::optional<RecordedRunResult> result(const std::string& events_path, std::string& fault);

  RecordingReader& recording_;
  const DrivenMap& map_;
  const PoseFilterSettings& guess_;
  const bool exact_;
  Residency memory_;
  RecordedLoader recorded_;
  TimedLoader timed_;  // from a checkpoint
  EventLog log_;
  RunRecorder recorder_;
  Cycle cycle_;
  std::vector<LoadResult> loads_;  // of the cycle
  std::vector<Command> commands_;  // of the cycle
  std::vector<Command> waiting_;   // for the cycles to come
  std::uint64_t frames_ = 0;
  ByteCount bytes_loaded_ = 0;
};

void Run::begin() {
  const std::optional<RecordedStart>& start = recording_.preface().start;
  if (!start) return;
  if (start->sigma_m && start->sigma_rad) {
    cycle_.start_at(start->now_ns, start->T_map_base, *start->sigma_m, *start->sigma_rad);
  } else {
    cycle_.start_at(start->now_ns, start->T_map_base);
  }
}

void Run::go_on_from(const Checkpoint& checkpoint) {
  for (const Checkpoint::Held& held : checkpoint.resident) {
    if (held.zone >= map_.needs.size()) continue;
    if (memory_.restore(held.zone, map_.needs[held.zone], held.generation)) {
      recorder_.begin_with(held.zone);
    }
  }
  cycle_.continue_from(checkpoint.cycle, checkpoint.start_ns);
  if (checkpoint.has_pose) {
    cycle_.start_at(checkpoint.now_ns, checkpoint.T_map_base,
                    std::max(checkpoint.sigma_m, guess_.start_sigma_m),
                    std::max(checkpoint.sigma_rad, guess_.start_sigma_rad));
  }
  const auto add = [&](Command::Kind kind, ZoneId zone) {
    Command& command = waiting_.emplace_back();
    command.kind = kind;
    command.zone = zone;
  };
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

bool Run::answers(const RecordedInput& input, std::string& fault) {
  for (const LoadResult& load : input.loads) {
    const std::optional<LoadRequest> asked = recorded_.asked();
    if (recorded_.answer(load)) continue;
    const auto told = [&](ZoneId zone, std::uint32_t generation) {
      const std::string name =
          zone < map_.needs.size() ? map_.graph.name(zone) : "number " + std::to_string(zone);
      return "zone " + name + " (generation " + std::to_string(generation) + ")";
    };
    fault = "diverged at cycle " + std::to_string(cycle_.state().cycles) +
            ": recorded is what became of a load of " + told(load.zone, load.generation) +
            ", but here " + (asked ? told(asked->zone, asked->generation) : std::string("none")) +
            " was asked for; replay with the version that recorded it, " +
            recording_.preface().program;
    return false;
  }
  return true;
}

// What became of loads: as recorded, or as modelled.
bool Run::take_loads(const RecordedInput& input, std::string& fault) {
  loads_.clear();
  if (exact_) {
    loads_ = input.loads;
    if (!answers(input, fault)) return false;
  } else {
    timed_.advance_to(input.now_ns);
    while (const auto load = timed_.poll()) loads_.push_back(*load);
  }
  for (const LoadResult& load : loads_) {
    if (load.error.code == ErrorCode::kOk) bytes_loaded_ += map_.work[load.zone].stored_bytes;
  }
  return true;
}

// The commands of the cycle, behind those of a checkpoint that do not fit in one.
void Run::take_commands(const RecordedInput& input) {
  waiting_.insert(waiting_.end(), input.commands.begin(), input.commands.end());
  const auto end = waiting_.begin() +
                   static_cast<std::ptrdiff_t>(std::min(waiting_.size(), Cycle::kMostCommands));
  commands_.assign(waiting_.begin(), end);
  waiting_.erase(waiting_.begin(), end);
}

bool Run::run_cycles(std::string& fault) {
  while (const RecordedInput* const recorded = recording_.next()) {
    if (!take_loads(*recorded, fault)) return false;
    take_commands(*recorded);
    cycle_.run({recorded->now_ns, recorded->frames, recorded->corrections, loads_, commands_});
    frames_ += recorded->frames.size();
    recorder_.after_cycle(record_of(recorded->now_ns, cycle_.state(), memory_));
  }
  return true;
}

std::optional<RecordedRunResult> Run::drive(const std::string& events_path, std::string& fault) {
  if (!events_path.empty()) {
    if (const auto opened = log_.write_to(events_path); !opened) {
      fault = events_path + ": cannot be written: " + to_string(opened.error().code);
      return std::nullopt;
    }
  }
  if (!map_.pin(memory_, fault)) return std::nullopt;
  if (exact_) {
    begin();
  } else {
    go_on_from(*recording_.checkpoint());
  }
  if (!run_cycles(fault)) return std::nullopt;
  cycle_.finish();
  return result(events_path, fault);
}

std::optional<RecordedRunResult> Run::result(const std::string& events_path, std::string& fault) {
  auto hash = log_.finish();
  if (!hash) {
    fault = events_path + ": cannot be written: " + to_string(hash.error().code);
    return std::nullopt;
  }
  RecordedRunResult result;
  RunSummary& summary = result.replay.summary;
  recorder_.summarise(summary);
  summarise_cycle(cycle_, summary);
  summary.bytes_loaded = bytes_loaded_;
  summary.can_frames = frames_;
  summary.event_log_hash = std::move(hash).value();
  result.replay.trace = recorder_.take_trace();
  describe_map(map_, result.replay.trace);
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
  const auto map = DrivenMap::make(run.catalog, recording.preface().terms, fault);
  if (!map) return std::nullopt;
  return Run(recording, run, *map).drive(events_path, fault);
}

}  // namespace zonepack
