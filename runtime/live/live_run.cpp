// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_run.hpp"

#include <cstring>

#include "platform/clock.hpp"
#include "platform/signals.hpp"
#include "runtime/live/bus_messages.hpp"
#include "runtime/live/live_parts.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kWatch_ns = 20'000'000;

}  // namespace

LiveRun::LiveRun(RunInputs& inputs, std::shared_ptr<MapVersion> map, LiveMemory& memory,
                 const Notifier& notifier, const LiveOptions& options)
    : parts_(std::make_unique<Parts>(inputs, std::move(map), memory, notifier, options)) {}

LiveRun::~LiveRun() {
  if (parts_->loop) parts_->loop->stop();
  if (parts_->source) parts_->source->stop();
}

bool LiveRun::start(std::string& fault) {
  Parts& p = *parts_;
  if (!p.options.events.empty()) {
    if (const auto opened = p.log.write_to(p.options.events); !opened) {
      fault = p.options.events + ": cannot be written: " + to_string(opened.error().code);
      return false;
    }
  }
  const auto map = p.first();
  const auto begun = p.shared.begin_map(static_cast<std::uint32_t>(map->model().needs.size()));
  ZP_REQUIRE(begun.ok());
  const CycleConfig config = cycle_config(p.inputs.settings);
  if (const auto fit = ZoneMarkers::check(map->model().graph, config.markers); !fit) {
    fault = fit.error().message;
    return false;
  }
  if (!p.lines.open(p.options.allow_degraded, fault)) return false;
  if (!map->prepare(config, p.loader, p.events, &p.shared, fault) || !p.open_source(fault)) {
    return false;
  }
  if (!p.place_at_start(fault) || !p.open_recorder(fault) || !p.open_service(fault)) return false;
  const bool served = p.zones_memory.served();
  p.maps.emplace(map->in_use(), p.loader, &p.shared);
  p.loop = std::make_unique<ControlLoop>(
      p.control_settings(), ControlPorts{.clock = p.source->clock(),
                                         .bus = p.bus(),
                                         .maps = *p.maps,
                                         .loader = p.loader,
                                         .notes = p.events,
                                         .overload = p.overload,
                                         .logged_corrections = p.source->corrections(),
                                         .poses = served ? &p.service.poses : nullptr,
                                         .commands = served ? &p.service.commands : nullptr,
                                         .replies = served ? &p.service.replies : nullptr,
                                         .edges = &p.lines.inputs.edges,
                                         .recorder = p.recording.tap(),
                                         .status = p.status});
  if (p.recording.tap() != nullptr) p.recording.tap()->follow(p.loop->last_status().state);
  p.change.emplace(MapChangePorts{p.inputs.settings, p.terms_of_next, p.shared,
                                  p.inputs.settings.loading.read, p.loader, p.events, *p.loop,
                                  p.registry, p.recording, p.service, Parts::tell});
  return p.start_threads(fault);
}

void LiveRun::wait() {
  if (const std::string warning = parts_->source->warning(); !warning.empty()) {
    Parts::tell("warning: " + warning);
  }
  BusMessages bus_messages(parts_->source->interface());
  const bool tells = parts_->options.source.kind != CanSourceChoice::Kind::kLog;
  while (!parts_->control_ended.load()) {
    if (tells) {
      if (const auto told = bus_messages.next(parts_->status.load().bus)) Parts::tell(*told);
    }
    switch (next_signal(monotonic_ns() + kWatch_ns)) {
      case Signal::kStop:
        parts_->loop->stop();
        break;
      case Signal::kReload:
        parts_->change->ask();
        break;
      case Signal::kNone:
        break;
    }
    parts_->change->turn();
  }
}

std::optional<RunSummary> LiveRun::finish(std::string& fault) {
  Parts& p = *parts_;
  p.control_thread.join();
  p.lines.stop();
  (void)p.notifier.stopping();
  p.service.stop();
  if (const int error = p.lock_error.load(); error != 0 && !p.options.allow_degraded) {
    fault = std::string("realtime.lock_memory: ") + std::strerror(error) +
            "; raise LimitMEMLOCK (ulimit -l) above the budget, or go on by --allow-degraded";
    return std::nullopt;
  }
  p.maps->map().cycle.finish();
  p.loader.stop();
  p.source->stop();
  p.log_thread.stop();
  if (p.state_saver) p.state_saver->stop();
  if (p.can_recorder) {
    if (const auto closed = p.can_recorder->close(); !closed) {
      fault = p.unwritten_recording(closed.error());
      return std::nullopt;
    }
  }
  auto hash = p.log.finish();
  if (!hash) {
    fault = p.options.events + ": cannot be written: " + to_string(hash.error().code);
    return std::nullopt;
  }
  if (const auto problem = p.recording.finish(*hash)) {
    fault = *problem;
    return std::nullopt;
  }
  RunSummary summary = p.summary();
  summary.event_log_hash = std::move(hash).value();
  return summary;
}

const CanLogSummary* LiveRun::log_summary() const {
  return parts_->source ? parts_->source->log_summary() : nullptr;
}

}  // namespace zonepack
