// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "runtime/replay/pack_filler.hpp"
#include "runtime/run/event_log.hpp"
#include "runtime/run/map_model.hpp"
#include "runtime/run/run_inputs.hpp"
#include "runtime/run/run_result.hpp"
#include "runtime/run/run_statistics.hpp"

namespace zonepack {
namespace {

// All that one run needs, in the order in which the parts refer to each other.
class LogDrive {
 public:
  LogDrive(ReplayInput& input, const MapModel& map)
      : input_(input),
        map_(map),
        memory_(map.needs.size(), map.limits),
        filler_(input.load_packs ? std::make_unique<PackFiller>(map.catalog, map.slots) : nullptr),
        loader_(map.slots, map.work, input.terms.rates, filler_.get()),
        bus_(&input.frames),
        log_([this](ZoneId zone) { return std::string_view(map_.graph.name(zone)); }),
        recorder_(map.graph, map.needs, input.truth, input.terms.period_ns, map.limits, log_) {
    recorder_.keep_trace();
  }

  std::optional<ReplayResult> drive(std::string& fault);

 private:
  bool place_at_start(Cycle& cycle, std::int64_t start_ns, std::string& fault);
  void run_cycles(Cycle& cycle, std::int64_t start_ns);
  std::optional<ReplayResult> result(const Cycle& cycle, std::string& fault);

  ReplayInput& input_;
  const MapModel& map_;
  Residency memory_;
  std::unique_ptr<PackFiller> filler_;
  ModelledLoader loader_;
  SimCanBus bus_;
  EventLog log_;
  RunStatistics recorder_;
  std::uint64_t frames_ = 0;
};

bool LogDrive::place_at_start(Cycle& cycle, std::int64_t start_ns, std::string& fault) {
  std::optional<Pose2> start = input_.start;
  if (input_.start_at_truth) {
    start = first_truth(input_.truth, start_ns);
    if (!start) {
      fault = "--start truth: the truth file does not cover the start of the CAN log";
      return false;
    }
  }
  if (start) cycle.start_at(start_ns, *start);
  return true;
}

std::optional<ReplayResult> LogDrive::drive(std::string& fault) {
  if (!input_.events_path.empty()) {
    if (const auto opened = log_.write_to(input_.events_path); !opened) {
      fault = input_.events_path + ": cannot be written: " + to_string(opened.error().code);
      return std::nullopt;
    }
  }
  const auto first = bus_.next_arrival_ns();
  if (!first) {
    fault = "the CAN log holds no frame";
    return std::nullopt;
  }
  if (!map_.pin(memory_, fault)) return std::nullopt;
  Cycle cycle(input_.cycle,
              {map_.graph, map_.needs, map_.load_s, map_.pinned, memory_, loader_, recorder_});
  if (!place_at_start(cycle, *first, fault)) return std::nullopt;
  run_cycles(cycle, *first);
  cycle.finish();
  return result(cycle, fault);
}

void LogDrive::run_cycles(Cycle& cycle, std::int64_t start_ns) {
  std::vector<CanFrame> frames(input_.most_frames);
  std::vector<LoadResult> loads;
  const std::vector<PoseCorrection>& corrections = input_.corrections;
  std::size_t taken = 0;
  for (std::int64_t now_ns = start_ns;; now_ns += input_.terms.period_ns) {
    bus_.advance_to(now_ns);
    loader_.advance_to(now_ns);
    const std::size_t count = bus_.receive(frames);
    frames_ += count;
    std::size_t end = taken;
    while (end < corrections.size() && corrections[end].received_ns <= now_ns) ++end;
    loads.clear();
    while (const auto load = loader_.poll()) loads.push_back(*load);
    cycle.run(
        {now_ns, {frames.data(), count}, {corrections.data() + taken, end - taken}, loads, {}});
    taken = end;
    recorder_.after_cycle(record_of(now_ns, cycle.state(), memory_));
    if (!bus_.next_arrival_ns()) return;
  }
}

std::optional<ReplayResult> LogDrive::result(const Cycle& cycle, std::string& fault) {
  auto hash = log_.finish();
  if (!hash) {
    fault = input_.events_path + ": cannot be written: " + to_string(hash.error().code);
    return std::nullopt;
  }
  ReplayResult result;
  RunSummary& summary = result.summary;
  recorder_.summarise(summary);
  summary.bytes_loaded = loader_.bytes_loaded();
  summarise_cycle(cycle, summary);
  summary.can_frames = frames_;
  summary.event_log_hash = std::move(hash).value();
  result.trace = recorder_.take_trace();
  describe_map(map_, result.trace);
  if (filler_) result.faults = filler_->faults();
  return result;
}

}  // namespace

std::optional<ReplayResult> replay(ReplayInput input, std::string& fault) {
  const auto map = MapModel::make(input.catalog, input.terms, fault);
  if (!map) return std::nullopt;
  auto result = LogDrive(input, *map).drive(fault);
  if (result && map->warning) result->warnings.push_back(*map->warning);
  return result;
}

}  // namespace zonepack
