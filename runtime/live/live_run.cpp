// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_run.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/require.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/signals.hpp"
#include "runtime/live/messages/bus_messages.hpp"
#include "runtime/live/messages/print_line.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kWatch_ns = 20'000'000;

}  // namespace

LiveRun::LiveRun(RunInputs& inputs, std::shared_ptr<MapVersion> map, LiveMemory& memory,
                 const Notifier& notifier, EndGuard& guard, LiveOptions options)
    : files_(inputs),
      settings_(inputs.settings),
      memory_(memory),
      notifier_(notifier),
      guard_(guard),
      options_(std::move(options)),
      period_ns_(options_.preface.terms.period_ns),
      zones_(static_cast<std::uint32_t>(map->model().needs.size())),
      control_(settings_, map->catalog(), memory.map()),
      run_({.cycle = cycle_config(settings_),
            .terms = options_.preface.terms,
            .truth = inputs.truth ? &*inputs.truth : nullptr,
            .events = options_.events},
           std::move(map)),
      observers_(run_, control_, memory, options_.quiet),
      lines_(kernel_gpio(), settings_.gpio) {
  observers_.keep_habits(std::move(options_.habits));
}

// After a start that failed half way, threads may still use what is destroyed before them.
LiveRun::~LiveRun() {
  control_.stop();
  inputs_.stop();
  (void)control_.join();
  control_.loader.stop();
}

Outcome<void> LiveRun::start() {
  const auto begun = memory_.map().begin_map(zones_);
  ZP_REQUIRE(begun.ok());
  auto markers =
      ZoneMarkers::check(run_.accounted_map().model().graph, cycle_config(settings_).markers);
  if (!markers) return markers;
  if (auto opened = lines_.open(options_.allow_degraded); !opened) return opened;
  if (auto opened = run_.open(
          {.loader = control_.loader, .queue = &observers_.events, .directory = &memory_.map()});
      !opened) {
    return opened;
  }
  if (auto opened = open_control(); !opened) return opened;
  return start_threads();
}

Outcome<void> LiveRun::open_control() {
  auto opened = inputs_.open({.choice = options_.source,
                              .settings = settings_,
                              .corrections = std::move(files_.corrections),
                              .period_ns = period_ns_,
                              .notes = observers_.notes,
                              .allow_degraded = options_.allow_degraded},
                             options_.record_can);
  if (!opened) return opened;
  if (inputs_.captures()) observers_.log_thread.add_task([this] { inputs_.write(); });
  if (auto chosen = choose_start(); !chosen) return chosen;
  opened = observers_.open_recording(options_.recording, std::exchange(options_.preface, {}),
                                     settings_.cycle.most_frames);
  if (!opened) return opened;
  opened = observers_.open_service(settings_.serve, lines_.board, options_.build);
  if (!opened) return opened;

  Service& service = observers_.service;
  InputTap* const tap = observers_.recording.tap();
  const bool served = memory_.served();
  control_.open(control_settings(), {.clock = inputs_.source().clock(),
                                     .bus = inputs_.bus(),
                                     .maps = run_.switcher(),
                                     .loader = control_.loader,
                                     .notes = observers_.events,
                                     .overload = control_.overload,
                                     .logged_corrections = inputs_.source().corrections(),
                                     .poses = served ? &service.poses : nullptr,
                                     .commands = served ? &service.commands : nullptr,
                                     .replies = served ? &service.replies : nullptr,
                                     .edges = &lines_.inputs.edges,
                                     .tap = tap,
                                     .status = control_.status});
  if (tap != nullptr) tap->follow(control_.loop().last_status().state);
  change_.emplace(MapChangePorts{.settings = settings_,
                                 .shared = memory_.map(),
                                 .loop = control_.loop(),
                                 .run = run_,
                                 .recording = observers_.recording,
                                 .service = service});
  return {};
}

// As chosen, else where the robot was when it stopped, else the first fix.
Outcome<void> LiveRun::choose_start() {
  const std::int64_t start_ns = inputs_.source().start_ns();
  const TruthTrack* const truth = files_.truth ? &*files_.truth : nullptr;
  auto start = find_start(options_.start, truth, start_ns);
  if (!start) return start.error();
  const auto restored =
      observers_.restore(options_.recording.state_folder, settings_.pose, start_ns);
  if (!*start) *start = restored;
  if (*start) run_.start_at(**start);
  options_.preface.start = *start;
  return {};
}

ControlSettings LiveRun::control_settings() const {
  ControlSettings settings;
  settings.wall_period_ns = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(static_cast<double>(period_ns_) / options_.source.speed + 0.5));
  settings.may_skip = inputs_.source().robot();
  settings.judge_deadlines = options_.source.speed == 1;
  settings.most_frames = settings_.cycle.most_frames;
  return settings;
}

Outcome<void> LiveRun::start_threads() {
  if (auto started = observers_.start(); !started) return started;
  if (auto started = control_.start(options_.allow_degraded); !started) return started;
  const auto load_end = [this] {
    const auto load = control_.loader.last_load();
    return LoadEnd{load.zone, load.ns};
  };
  const auto driving = lines_.start([this] { return control_.status.load(); }, load_end,
                                    control_settings().wall_period_ns);
  if (!driving) return privilege_failure("gpio", driving.error());
  if (auto serving = observers_.serve(notifier_); !serving) return serving;
  (void)notifier_.ready();
  return {};
}

void LiveRun::wait() {
  if (const std::string warning = inputs_.source().warning(); !warning.empty()) {
    print_line("warning: " + warning);
  }
  BusMessages bus_messages(inputs_.source().interface());
  const bool has_bus = options_.source.kind != CanSourceChoice::Kind::kLog;
  while (!control_.ended()) {
    if (has_bus) {
      if (const auto line = bus_messages.next(control_.status.load().bus)) print_line(*line);
    }
    switch (next_signal(monotonic_ns() + kWatch_ns)) {
      case Signal::kStop:
        guard_.stop_asked();
        control_.stop();
        inputs_.source().ask_stop();
        break;
      case Signal::kReload:
        change_->ask();
        break;
      case Signal::kNone:
        break;
    }
    change_->turn();
  }
}

Outcome<RunSummary> LiveRun::finish(Failures& outputs) {
  guard_.watch();
  const auto controlled = control_.join();
  guard_.waits_for("the thread that reads a new version of the map from its folder");
  change_->stop();
  guard_.waits_for("the threads of the GPIO lines");
  lines_.stop();
  (void)notifier_.stopping();
  guard_.waits_for("the thread that serves clients");
  observers_.stop_serving();
  if (!controlled) return controlled.error();
  run_.end();
  guard_.waits_for("the thread that loads zones from the map's folder");
  control_.loader.stop();
  guard_.waits_for("the source of frames (--can)");
  inputs_.stop();
  guard_.waits_for("the thread that writes --events, --record and --record-can, or the state");
  observers_.stop();
  guard_.waits_for("--record-can");
  outputs.add(inputs_.close());
  guard_.waits_for("--events");
  RunSummary summary =
      run_.summarise(control_.loader.bytes_loaded(), control_.loop().last_status().can_frames);
  outputs.add(run_.close_events());
  guard_.waits_for("--record");
  outputs.add(observers_.recording.finish(summary.event_log_hash));
  guard_.waits_for("--json and the summary");
  return with_live_figures(std::move(summary));
}

RunSummary LiveRun::with_live_figures(RunSummary summary) const {
  LiveFigures live = control_.figures();
  live.process_peak_bytes = process_peak_bytes();
  const MapModel& map = run_.accounted_map().model();
  const ByteCount mapped = map.limits.fixed + map.slots * map.limits.slot_bytes;
  live.overhead_bytes = live.process_peak_bytes - std::min(mapped, live.process_peak_bytes);
  live.ready_us = timing_us(lines_.outputs.ready_latency());
  live.ready_count = lines_.outputs.ready_latency().count();
  live.lines_not_working = lines_.not_working();
  summary.live = live;
  return summary;
}

}  // namespace zonepack
