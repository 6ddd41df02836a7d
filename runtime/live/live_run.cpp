// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_run.hpp"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <string_view>

#include "platform/clock.hpp"
#include "platform/realtime.hpp"
#include "platform/signals.hpp"
#include "runtime/event_log.hpp"
#include "runtime/live/bus_teller.hpp"
#include "runtime/live/can_recorder.hpp"
#include "runtime/live/control_loop.hpp"
#include "runtime/live/event_teller.hpp"
#include "runtime/live/live_lines.hpp"
#include "runtime/live/live_loader.hpp"
#include "runtime/live/live_source.hpp"
#include "runtime/live/map_change.hpp"
#include "runtime/live/scribe.hpp"
#include "runtime/live/service.hpp"
#include "runtime/memory/shared_map.hpp"
#include "runtime/replay/run_recorder.hpp"
#include "runtime/state/state_saver.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kNotes = 2048;
constexpr std::int64_t kWatch_ns = 20'000'000;

void tell(const std::string& message) { std::cerr << "zoned: " + message + "\n"; }

double us(std::int64_t ns) { return static_cast<double>(ns) / 1000; }

LiveFigures::Timing timing_of(const Histogram& histogram) {
  const TimingFigures figures = histogram.figures();
  return {us(figures.p50), us(figures.p99), us(figures.p999), us(figures.p9999), us(figures.max)};
}

}  // namespace

// In the order in which the parts refer to each other.
struct LiveRun::Parts {
  Parts(RunInputs& run_inputs, std::shared_ptr<RunMap> map, LiveMemory& live_memory,
        const Notifier& run_notifier, const LiveOptions& run_options)
      : inputs(run_inputs),
        terms_of_next(map->driven().terms_of_next(run_options.preface.terms)),
        zones_memory(live_memory),
        notifier(run_notifier),
        options(run_options),
        period_ns(map_terms({}, inputs.settings).period_ns),
        shared(live_memory.map()),
        loader(map->catalog(), shared,
               {inputs.settings.loading.read, inputs.settings.loading.rate_limit}),
        notes(kNotes),
        follower(
            map, [this](std::uint32_t number) { return shelf.find(number); },
            [this](const RunMap& next) { account_for(next); }),
        log([this](ZoneId zone) {
          return std::string_view(follower.map().driven().graph.name(zone));
        }),
        recording(log),
        truth(inputs.truth ? &*inputs.truth : nullptr),
        teller(follower, recording),
        recorder(map->driven().graph, map->driven().needs, truth, period_ns, map->driven().limits,
                 teller),
        scribe(notes, follower, recorder),
        events(notes, live_memory.served() ? &service.events : nullptr, overload),
        lines(kernel_gpio(), run_inputs.settings.gpio) {
    shelf.add(std::move(map));
  }

  std::shared_ptr<RunMap> first() const { return shelf.find(1); }
  void account_for(const RunMap& next);

  bool open_source(std::string& fault);
  CanBus& bus();
  std::string unwritten_recording(const Error& error) const;
  bool place_at_start(std::string& fault);
  void restore_state();
  void begin_at(const RecordedStart& start);
  bool open_recorder(std::string& fault);
  bool open_service(std::string& fault);
  bool start_threads(std::string& fault);
  ControlSettings control_settings() const;
  void control() noexcept;

  RunInputs& inputs;
  MapTerms terms_of_next;
  LiveMemory& zones_memory;
  const Notifier& notifier;
  LiveOptions options;
  std::int64_t period_ns;
  SharedMap& shared;
  MapShelf shelf;
  LiveLoader loader;
  SpscQueue<LiveNote> notes;
  MapFollower follower;  // the scribe's
  EventLog log;
  LiveRecorder recording;
  std::optional<StateStore> state_store;
  std::optional<StateSaver> state_saver;
  const TruthTrack* truth;
  EventTeller teller;
  RunRecorder recorder;
  Scribe scribe;
  OverloadCounters overload;
  Service service;
  EventFanOut events;
  LiveLines lines;
  Seqlock<LiveStatus> status;
  std::unique_ptr<LiveSource> source;
  std::unique_ptr<CanRecorder> can_recorder;
  std::optional<MapRun> maps;
  std::unique_ptr<ControlLoop> loop;
  std::optional<MapChange> change;
  Thread control_thread;
  std::atomic<bool> control_ended{false};
  std::atomic<int> lock_error{0};
};

void LiveRun::Parts::account_for(const RunMap& next) {
  const DrivenMap& map = next.driven();
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
  can_recorder = std::make_unique<CanRecorder>(source->bus(), source->interface(),
                                               source->clock().offset_ns());
  scribe.add_task([this] { can_recorder->write(); });
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
    const auto map = shelf.find(glimpse.map);
    if (map == nullptr) return false;
    state.map_version = map->catalog().version;
    state.zone = glimpse.zone == kNoZone ? std::string() : map->driven().graph.name(glimpse.zone);
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
      recording.open(options.recorder, options.preface, first()->driven().needs.size(),
                     inputs.settings.cycle.most_frames, fault, warnings);
  for (const std::string& warning : warnings) tell(warning);
  options.preface = {};
  if (!opened || recording.tap() == nullptr) return opened;
  scribe.add_task([this] { recording.drain(); });
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
  if (const auto started = scribe.start(); !started) return refused("scribe", started.error());
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
  if (const auto driven = lines.start([this] { return status.load(); },
                                      [this] {
                                        const auto load = loader.last_load();
                                        return LoadEnd{load.zone, load.ns};
                                      },
                                      control_settings().wall_period_ns);
      !driven) {
    return refused("gpio", driven.error());
  }
  if (const auto serving = service.start(notifier, [this] { return loop->cycles(); }); !serving) {
    return refused("serve", serving.error());
  }
  (void)notifier.ready();
  return true;
}

LiveRun::LiveRun(RunInputs& inputs, std::shared_ptr<RunMap> map, LiveMemory& memory,
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
  const auto begun = p.shared.begin_map(static_cast<std::uint32_t>(map->driven().needs.size()));
  ZP_REQUIRE(begun.ok());
  const CycleConfig config = cycle_config(p.inputs.settings);
  if (const auto wrong = ZoneMarkers::fault_of(map->driven().graph, config.markers)) {
    fault = *wrong;
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
                                  p.shelf, p.recording, p.service, tell});
  return p.start_threads(fault);
}

void LiveRun::wait() {
  if (const std::string warning = parts_->source->warning(); !warning.empty()) {
    tell("warning: " + warning);
  }
  BusTeller teller(parts_->source->interface());
  const bool tells = parts_->options.source.kind != CanSourceChoice::Kind::kLog;
  while (!parts_->control_ended.load()) {
    if (tells) {
      if (const auto told = teller.tell(parts_->status.load().bus)) tell(*told);
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
  p.scribe.stop();
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
  const LiveStatus& last = p.loop->last_status();
  RunSummary summary;
  p.recorder.summarise(summary);
  summary.bytes_loaded = p.loader.bytes_loaded();
  summary.zone_switches = last.state.zone_switches;
  summary.can_frames = last.can_frames;
  summary.can_rejected = last.odometry.rejected;
  summary.corrections_used = last.filter.used;
  summary.corrections_rejected = last.filter.rejected;
  summary.event_log_hash = std::move(hash).value();
  LiveFigures live;
  live.process_peak_bytes = process_peak_bytes();
  const DrivenMap& map = p.follower.map().driven();
  const ByteCount mapped = map.limits.fixed + map.slots * map.limits.slot_bytes;
  live.overhead_bytes = live.process_peak_bytes - std::min(mapped, live.process_peak_bytes);
  live.minor_faults = last.minor_faults;
  live.major_faults = last.major_faults;
  live.allocations = p.loop->allocations();
  live.missed_deadlines = last.overload.missed_deadlines;
  live.cycle_us = timing_of(p.loop->work());
  live.wakeup_us = timing_of(p.loop->wakeup());
  const WorstCycle& worst = last.worst;
  live.worst = {worst.cycle,  us(worst.ns),      us(worst.step_ns), to_string(worst.step),
                worst.frames, worst.corrections, worst.loads,       worst.commands};
  live.lost_events = last.overload.lost_events;
  live.ready_us = timing_of(p.lines.outputs.ready_latency());
  live.ready_count = p.lines.outputs.ready_latency().count();
  live.lines_not_working = p.lines.not_working();
  live.realtime = p.control_thread.is_realtime();
  live.memory_locked = p.inputs.settings.realtime.lock_memory && p.lock_error.load() == 0;
  summary.live = live;
  return summary;
}

const CanLogSummary* LiveRun::log_summary() const {
  return parts_->source ? parts_->source->log_summary() : nullptr;
}

}  // namespace zonepack
