// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "runtime/event_log.hpp"
#include "runtime/replay/map_model.hpp"
#include "runtime/replay/pack_filler.hpp"
#include "runtime/replay/run_recorder.hpp"

namespace zonepack {
namespace {

constexpr double kNear_s = 1.0;

// The true pose at the start; truth may begin a little after the bus.
std::optional<Pose2> first_truth(const TruthTrack* truth, std::int64_t start_ns) {
  if (truth == nullptr) return std::nullopt;
  if (const auto pose = truth->at(start_ns)) return pose;
  const TruthTrack::Sample& first = truth->samples().front();
  const bool near =
      first.t_ns > start_ns && static_cast<double>(first.t_ns - start_ns) < kNear_s * 1e9;
  return near ? std::optional(first.T_map_base) : std::nullopt;
}

bool find_pins(const ReplayInput& input, std::vector<ZoneId>& pinned, std::string& fault) {
  for (const std::string& name : input.pinned) {
    const ZoneId zone = input.catalog.find(name);
    if (zone == kNoZone) {
      fault = "memory.pinned: the map " + input.catalog.folder + " has no zone " + name;
      return false;
    }
    if (std::find(pinned.begin(), pinned.end(), zone) == pinned.end()) pinned.push_back(zone);
  }
  return true;
}

// All that one run needs, in the order in which the parts refer to each other.
class Run {
 public:
  Run(ReplayInput& input, const std::vector<ZoneId>& pinned, const ResidencyLimits& limits)
      : input_(input),
        pinned_(pinned),
        graph_(graph_of(input.catalog)),
        needs_(needs_of(input.catalog)),
        work_(work_of(input.catalog)),
        load_s_(load_times_of(work_, input.rates, input.period_ns)),
        memory_(needs_.size(), limits),
        slots_(most_slots()),
        filler_(input.load_packs ? std::make_unique<PackFiller>(input.catalog, slots_) : nullptr),
        loader_(slots_, work_, input.rates, filler_.get()),
        bus_(&input.frames),
        log_([this](ZoneId zone) { return std::string_view(graph_.name(zone)); }),
        recorder_(graph_, needs_, input.truth, input.period_ns, limits, log_) {}

  std::optional<ReplayResult> drive(std::string& fault);

 private:
  // No more slots than all zones together fill: a generous budget reserves no memory for nothing.
  std::uint32_t most_slots() const {
    std::uint64_t all = 0;
    for (const ZoneNeed& need : needs_) all += need.slots;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(all, memory_.slot_count()));
  }

  bool pin(std::string& fault);
  bool place_at_start(Cycle& cycle, std::int64_t start_ns, std::string& fault);
  void run_cycles(Cycle& cycle, std::int64_t start_ns);
  std::optional<ReplayResult> result(const Cycle& cycle, std::string& fault);
  void describe_map(RunTrace& trace) const;

  ReplayInput& input_;
  const std::vector<ZoneId>& pinned_;
  ZoneGraph graph_;
  std::vector<ZoneNeed> needs_;
  std::vector<LoadWork> work_;
  std::vector<float> load_s_;
  Residency memory_;
  std::uint32_t slots_;
  std::unique_ptr<PackFiller> filler_;
  ModelledLoader loader_;
  SimCanBus bus_;
  EventLog log_;
  RunRecorder recorder_;
  std::uint64_t frames_ = 0;
};

bool Run::pin(std::string& fault) {
  for (const ZoneId zone : pinned_) {
    if (memory_.pin(zone, needs_[zone])) continue;
    fault = "memory.pinned: zone " + graph_.name(zone) +
            " does not fit beside the largest pair of neighbours in a budget of " +
            format_byte_count(memory_.limits().budget) + "; pin less or allow more";
    return false;
  }
  return true;
}

bool Run::place_at_start(Cycle& cycle, std::int64_t start_ns, std::string& fault) {
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

std::optional<ReplayResult> Run::drive(std::string& fault) {
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
  if (!pin(fault)) return std::nullopt;
  Cycle cycle(input_.cycle, {graph_, needs_, load_s_, pinned_, memory_, loader_, recorder_});
  if (!place_at_start(cycle, *first, fault)) return std::nullopt;
  run_cycles(cycle, *first);
  cycle.finish();
  return result(cycle, fault);
}

void Run::run_cycles(Cycle& cycle, std::int64_t start_ns) {
  std::vector<CanFrame> frames(input_.most_frames);
  std::vector<LoadResult> loads;
  const std::vector<PoseCorrection>& corrections = input_.corrections;
  std::size_t taken = 0;
  for (std::int64_t now_ns = start_ns;; now_ns += input_.period_ns) {
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

std::optional<ReplayResult> Run::result(const Cycle& cycle, std::string& fault) {
  auto hash = log_.finish();
  if (!hash) {
    fault = input_.events_path + ": cannot be written: " + to_string(hash.error().code);
    return std::nullopt;
  }
  ReplayResult result;
  RunSummary& summary = result.summary;
  recorder_.summarise(summary);
  summary.bytes_loaded = loader_.bytes_loaded();
  summary.zone_switches = cycle.state().zone_switches;
  summary.can_frames = frames_;
  summary.can_rejected = cycle.odometry_counters().rejected;
  summary.corrections_used = cycle.filter_counters().used;
  summary.corrections_rejected = cycle.filter_counters().rejected;
  summary.event_log_hash = std::move(hash).value();
  result.trace = recorder_.take_trace();
  describe_map(result.trace);
  if (filler_) result.faults = filler_->faults();
  return result;
}

void Run::describe_map(RunTrace& trace) const {
  const ResidencyLimits& limits = memory_.limits();
  for (const CatalogZone& zone : input_.catalog.zones) {
    trace.zones.push_back(
        {zone.name, zone.zone_type, zone.polygon, zone.signatures, zone.slots * limits.slot_bytes});
  }
  for (const CatalogPortal& portal : input_.catalog.portals) {
    trace.portals.push_back({portal.segment, portal.zone_a, portal.zone_b});
  }
  trace.budget_bytes = limits.budget;
  trace.fixed_bytes = limits.fixed;
  trace.max_signatures = limits.max_signatures;
  trace.duration_s = trace.samples.empty() ? 0 : trace.samples.back().t_s;
}

}  // namespace

std::optional<ReplayResult> replay(ReplayInput input, std::string& fault) {
  std::vector<ZoneId> pinned;
  if (!find_pins(input, pinned, fault)) return std::nullopt;
  const ResidencyLimits limits =
      limits_for(input.catalog, input.budget, input.max_signatures, pinned);
  if (const auto refused = refusal(input.catalog, limits)) {
    fault = *refused;
    return std::nullopt;
  }
  auto result = Run(input, pinned, limits).drive(fault);
  if (result) {
    if (auto warning = tightness(input.catalog, limits)) result->warnings.push_back(*warning);
  }
  return result;
}

}  // namespace zonepack
