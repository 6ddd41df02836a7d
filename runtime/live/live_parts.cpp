// SPDX-License-Identifier: Apache-2.0
// How the parts of a live run are opened, its threads started, and what it says of itself in the
// end.
#include "runtime/live/live_parts.hpp"

#include <algorithm>
#include <cstring>
#include <iostream>

namespace zonepack {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) / 1000; }

LiveFigures::Timing timing_of(const Histogram& histogram) {
  const TimingFigures figures = histogram.figures();
  return {us(figures.p50), us(figures.p99), us(figures.p999), us(figures.p9999), us(figures.max)};
}

}  // namespace

void LiveRun::Parts::tell(const std::string& message) { std::cerr << "zoned: " + message + "\n"; }

void LiveRun::Parts::account_for(const MapVersion& next) {
  const MapModel& map = next.model();
  recording.change_map(next.number(), map.needs.size());
  recorder.change_map(map.graph, map.needs, map.limits);
}

bool LiveRun::Parts::open_source(std::string& fault) {
  source = LiveSource::open({.choice = options.source,
                             .settings = inputs.settings,
                             .corrections = std::move(inputs.corrections),
                             .period_ns = period_ns,
                             .notes = notes,
                             .allow_degraded = options.allow_degraded},
                            fault);
  if (source == nullptr || options.record_can.empty()) return source != nullptr;
  can_recorder =
      std::make_unique<CanCapture>(source->bus(), source->interface(), source->clock().offset_ns());
  log_thread.add_task([this] { can_recorder->write(); });
  const auto opened = can_recorder->open(options.record_can);
  if (!opened) fault = unwritten_recording(opened.error());
  return opened.ok();
}

CanBus& LiveRun::Parts::bus() { return can_recorder ? *can_recorder : source->bus(); }

std::string LiveRun::Parts::unwritten_recording(const Error& error) const {
  return options.record_can +
         ": cannot be written: " + std::strerror(static_cast<int>(error.detail));
}

bool LiveRun::Parts::place_at_start(std::string& fault) {
  std::optional<Pose2> start;
  if (options.start.kind == StartChoice::Kind::kPose) start = options.start.pose;
  if (options.start.kind == StartChoice::Kind::kTruth) {
    start = first_truth(truth, source->start_ns());
    if (!start) {
      fault = "--start truth: the truth file does not cover the start of the CAN log";
      return false;
    }
  }
  restore_state();
  if (start) begin_at({source->start_ns(), *start, {}, {}});
  return true;
}

// Where the robot was when it stopped, unless somebody knows better.
void LiveRun::Parts::restore_state() {
  if (options.recorder.state_folder.empty()) return;
  state_store.emplace(options.recorder.state_folder);
  const Digest16 lineage = first()->catalog().lineage;
  const StateStore::Found found = state_store->load(lineage);
  for (const std::string& note : found.notes) tell(note);
  SavedState next;
  next.map_lineage = lineage;
  next.runs = 1 + (found.state ? found.state->runs : 0);
  if (found.state && options.start.kind == StartChoice::Kind::kFix) {
    const RestoredStart guess = guess_from(*found.state, inputs.settings.pose);
    begin_at({source->start_ns(), guess.T_map_base, guess.sigma_m, guess.sigma_rad});
  }
  const auto look = [this] {
    const LiveStatus now = status.load();
    return StateGlimpse{now.now_ns, now.state.pose, now.state.map, now.state.zone};
  };
  const auto place = [this](const StateGlimpse& glimpse, SavedState& state) {
    const auto map = registry.find(glimpse.map);
    if (map == nullptr) return false;
    state.map_version = map->catalog().version;
    state.zone = glimpse.zone == kNoZone ? std::string() : map->model().graph.name(glimpse.zone);
    return true;
  };
  state_saver.emplace(*state_store, next, look, place, tell);
}

void LiveRun::Parts::begin_at(const RecordedStart& start) {
  options.preface.start = start;
  if (start.sigma_m && start.sigma_rad) {
    first()->cycle().start_at(start.now_ns, start.T_map_base, *start.sigma_m, *start.sigma_rad);
  } else {
    first()->cycle().start_at(start.now_ns, start.T_map_base);
  }
}

bool LiveRun::Parts::open_recorder(std::string& fault) {
  std::vector<std::string> warnings;
  const bool opened =
      recording.open(options.recorder, options.preface, first()->model().needs.size(),
                     inputs.settings.cycle.most_frames, fault, warnings);
  for (const std::string& warning : warnings) tell(warning);
  options.preface = {};
  if (!opened || recording.tap() == nullptr) return opened;
  log_thread.add_task([this] { recording.drain(); });
  return true;
}

bool LiveRun::Parts::open_service(std::string& fault) {
  if (!zones_memory.served()) return true;
  ServeSettings settings = inputs.settings.serve;
  settings.socket = socket_path(settings);
  service.lines = &lines.board;
  std::function<Result<std::uint64_t>(int)> dump;
  if (FlightRecorder* const flight = recording.flight()) {
    dump = [flight](int fd) -> Result<std::uint64_t> {
      const auto dumped = flight->dump_to(fd);
      if (!dumped) return dumped.error();
      return dumped->bytes;
    };
  }
  return service.open(settings, status, zones_memory, first(), std::move(dump), fault);
}

ControlSettings LiveRun::Parts::control_settings() const {
  ControlSettings settings;
  settings.wall_period_ns = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(static_cast<double>(period_ns) / options.source.speed + 0.5));
  settings.may_skip = source->robot();
  settings.judge_deadlines = options.source.speed == 1;
  settings.most_frames = inputs.settings.cycle.most_frames;
  return settings;
}

void LiveRun::Parts::control() noexcept {
  // Behind the making of this thread, so that its stack is locked too.
  if (inputs.settings.realtime.lock_memory) {
    const auto locked = lock_memory_now();
    lock_error.store(locked ? 0 : static_cast<int>(locked.error().detail));
    loop->set_memory_locked(locked.ok());
  }
  if (lock_error.load() == 0 || options.allow_degraded) loop->run();
  control_ended.store(true);
}

bool LiveRun::Parts::start_threads(std::string& fault) {
  const RealtimeSettings& realtime = inputs.settings.realtime;
  const auto refused = [&](const char* what, const Error& error) {
    fault = std::string(what) + ": " + std::strerror(static_cast<int>(error.detail)) +
            "; run as root, give the process CAP_SYS_NICE and CAP_IPC_LOCK (LimitRTPRIO and "
            "LimitMEMLOCK of its unit), or go on without by --allow-degraded";
    return false;
  };
  if (const auto started = log_thread.start(); !started)
    return refused("log thread", started.error());
  if (state_saver) {
    if (const auto started = state_saver->start(); !started) {
      return refused("state", started.error());
    }
  }
  const ThreadSettings for_loader{.name = "zoned-loader",
                                  .fifo_priority = static_cast<int>(realtime.loader_priority)};
  if (const auto started = loader.start(for_loader, options.allow_degraded); !started) {
    return refused("realtime.loader_priority", started.error());
  }
  const ThreadSettings for_control{.name = "zoned-control",
                                   .fifo_priority = static_cast<int>(realtime.priority),
                                   .cpu = realtime.cpu.empty() ? -1 : std::stoi(realtime.cpu)};
  auto started = Thread::start(for_control, options.allow_degraded, [this] { control(); });
  if (!started) return refused("realtime.priority", started.error());
  control_thread = std::move(started).value();
  if (const auto driving = lines.start([this] { return status.load(); },
                                      [this] {
                                        const auto load = loader.last_load();
                                        return LoadEnd{load.zone, load.ns};
                                      },
                                      control_settings().wall_period_ns);
      !driving) {
    return refused("gpio", driving.error());
  }
  if (const auto serving = service.start(notifier, [this] { return loop->cycles(); }); !serving) {
    return refused("serve", serving.error());
  }
  (void)notifier.ready();
  return true;
}

RunSummary LiveRun::Parts::summary() const {
  const LiveStatus& last = loop->last_status();
  RunSummary figures;
  recorder.summarise(figures);
  figures.bytes_loaded = loader.bytes_loaded();
  figures.zone_switches = last.state.zone_switches;
  figures.can_frames = last.can_frames;
  figures.can_rejected = last.odometry.rejected;
  figures.corrections_used = last.filter.used;
  figures.corrections_rejected = last.filter.rejected;
  LiveFigures live;
  live.process_peak_bytes = process_peak_bytes();
  const MapModel& map = follower.map().model();
  const ByteCount mapped = map.limits.fixed + map.slots * map.limits.slot_bytes;
  live.overhead_bytes = live.process_peak_bytes - std::min(mapped, live.process_peak_bytes);
  live.minor_faults = last.minor_faults;
  live.major_faults = last.major_faults;
  live.allocations = loop->allocations();
  live.missed_deadlines = last.overload.missed_deadlines;
  live.cycle_us = timing_of(loop->work());
  live.wakeup_us = timing_of(loop->wakeup());
  const WorstCycle& worst = last.worst;
  live.worst = {worst.cycle,  us(worst.ns),      us(worst.step_ns), to_string(worst.step),
                worst.frames, worst.corrections, worst.loads,       worst.commands};
  live.lost_events = last.overload.lost_events;
  live.ready_us = timing_of(lines.outputs.ready_latency());
  live.ready_count = lines.outputs.ready_latency().count();
  live.lines_not_working = lines.not_working();
  live.realtime = control_thread.is_realtime();
  live.memory_locked = inputs.settings.realtime.lock_memory && lock_error.load() == 0;
  figures.live = live;
  return figures;
}

}  // namespace zonepack
