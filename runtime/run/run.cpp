// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run.hpp"

#include <string_view>
#include <utility>

#include "platform/base/require.hpp"
#include "runtime/run/inputs/rejected_text.hpp"
#include "runtime/run/output_check.hpp"

namespace zonepack {
namespace {

// Fills the zones, portals and limits of a trace whose samples are there.
void describe_map(const MapModel& map, RunTrace& trace) {
  const ResidencyLimits& limits = map.limits;
  for (const CatalogZone& zone : map.catalog.zones) {
    trace.zones.push_back({.name = zone.name,
                           .zone_type = zone.zone_type,
                           .polygon = zone.polygon,
                           .signatures = zone.signatures,
                           .charged_bytes = zone.slots * limits.slot_bytes});
  }
  for (const CatalogPortal& portal : map.catalog.portals) {
    trace.portals.push_back(
        {.segment = portal.segment, .zone_a = portal.zone_a, .zone_b = portal.zone_b});
  }
  trace.budget_bytes = limits.budget;
  trace.fixed_bytes = limits.fixed;
  trace.max_signatures = limits.max_signatures;
  trace.duration_s = trace.samples.empty() ? 0 : trace.samples.back().t_s;
}

}  // namespace

Run::Run(RunPlan plan, std::shared_ptr<MapVersion> first)
    : plan_(std::move(plan)),
      terms_of_next_(first->model().terms_of_next(plan_.terms)),
      first_(plan_.keep_trace ? first : nullptr),
      accounted_(first),
      log_([this](ZoneId zone) { return std::string_view(accounted_->model().graph.name(zone)); }),
      statistics_(first->model().graph, first->model().needs, plan_.truth, plan_.terms.period_ns,
                  first->model().limits) {
  if (plan_.keep_trace) statistics_.keep_trace();
  maps_.add(std::move(first));
}

Outcome<void> Run::open(const RunPorts& ports) {
  if (!plan_.events.empty()) {
    if (const auto opened = log_.write_to(plan_.events); !opened) {
      return cannot_write(output_name(plan_.events), opened.error());
    }
  }
  ports_.emplace(ports);
  if (ports_->queue == nullptr) ports_->queue = this;
  const auto map = maps_.find(accounted_->number());
  if (auto prepared = prepare(*map); !prepared) return prepared;
  switcher_.emplace(map->in_use(), ports.loader, ports.directory);
  return {};
}

void Run::start_at(const RunStart& start) { zonepack::start_at(switcher_->map().cycle, start); }

void Run::step(const CycleInput& input) {
  switcher_->run(input);
  const MapInUse& map = switcher_->map();
  after_cycle(record_of(input.now_ns, map.cycle.state(), map.memory));
  if (const MapInUse* const unused = switcher_->take_unused()) maps_.remove(unused->number);
}

Outcome<std::shared_ptr<MapVersion>> Run::prepare(std::uint32_t number, Catalog catalog) const {
  auto map = MapVersion::make(number, std::move(catalog), terms_of_next_);
  if (!map) return map;
  if (const auto prepared = prepare(**map); !prepared) return prepared.error();
  return map;
}

Outcome<void> Run::prepare(MapVersion& map) const {
  return map.prepare(plan_.cycle, ports_->loader, *ports_->queue, ports_->directory,
                     plan_.eviction);
}

// Before what comes next is accounted for: it is of the map of this number.
void Run::follow(std::uint32_t map) noexcept {
  if (map == accounted_->number()) return;
  std::shared_ptr<const MapVersion> next = maps_.find(map);
  ZP_REQUIRE(next != nullptr);
  statistics_.change_map(next->model().graph, next->model().needs, next->model().limits);
  accounted_ = std::move(next);  // the one before may go with this
}

void Run::on_event(const Event& event) noexcept {
  follow(event.map);
  for (RunObserver* const observer : observers_) observer->on_event(event, *accounted_);
  log_.on_event(event);
  statistics_.on_event(event);
}

void Run::after_cycle(const CycleRecord& cycle) {
  follow(cycle.state.map);
  for (RunObserver* const observer : observers_) observer->after_cycle(cycle, *accounted_);
  statistics_.after_cycle(cycle);
}

Outcome<void> Run::close_events() {
  if (const auto closed = log_.close(); !closed)
    return cannot_write(output_name(plan_.events), closed.error());
  return {};
}

RunSummary Run::summarise(ByteCount bytes_loaded, std::uint64_t can_frames) const {
  RunSummary summary;
  statistics_.summarise(summary);
  const Cycle& cycle = switcher_->map().cycle;
  summary.bytes_loaded = bytes_loaded;
  summary.zone_switches = cycle.state().zone_switches;
  summary.can_frames = can_frames;
  summary.can_rejected = cycle.odometry_counters().rejected;
  summary.corrections_used = cycle.filter_counters().used;
  summary.corrections_rejected = cycle.filter_counters().rejected;
  summary.can_rejected_why = rejected_text(cycle.odometry_counters(), plan_.cycle.odometry);
  summary.corrections_rejected_why = rejected_text(cycle.filter_counters());
  summary.event_log_hash = log_.hash();
  return summary;
}

RunTrace Run::take_trace() {
  RunTrace trace = statistics_.take_trace();
  describe_map(first_->model(), trace);
  return trace;
}

}  // namespace zonepack
