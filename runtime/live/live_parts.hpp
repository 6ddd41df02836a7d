// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "platform/realtime.hpp"
#include "platform/seqlock.hpp"
#include "platform/spsc_queue.hpp"
#include "runtime/live/can_capture.hpp"
#include "runtime/live/control_loop.hpp"
#include "runtime/live/event_messages.hpp"
#include "runtime/live/live_lines.hpp"
#include "runtime/live/live_loader.hpp"
#include "runtime/live/live_run.hpp"
#include "runtime/live/live_source.hpp"
#include "runtime/live/log_thread.hpp"
#include "runtime/live/map_change.hpp"
#include "runtime/live/service.hpp"
#include "runtime/memory/shared_map.hpp"
#include "runtime/run/event_log.hpp"
#include "runtime/run/run_statistics.hpp"
#include "runtime/state/state_saver.hpp"

namespace zonepack {

// What a live run is made of, in the order in which the parts refer to each other. Of LiveRun
// alone.
struct LiveRun::Parts {
  static constexpr std::size_t kNotes = 2048;

  Parts(RunInputs& run_inputs, std::shared_ptr<MapVersion> map, LiveMemory& live_memory,
        const Notifier& run_notifier, const LiveOptions& run_options)
      : inputs(run_inputs),
        terms_of_next(map->model().terms_of_next(run_options.preface.terms)),
        zones_memory(live_memory),
        notifier(run_notifier),
        options(run_options),
        period_ns(map_terms({}, inputs.settings).period_ns),
        shared(live_memory.map()),
        loader(map->catalog(), shared,
               {inputs.settings.loading.read, inputs.settings.loading.rate_limit}),
        notes(kNotes),
        follower(
            map, [this](std::uint32_t number) { return registry.find(number); },
            [this](const MapVersion& next) { account_for(next); }),
        log([this](ZoneId zone) {
          return std::string_view(follower.map().model().graph.name(zone));
        }),
        recording(log),
        truth(inputs.truth ? &*inputs.truth : nullptr),
        event_messages(follower, recording),
        recorder(map->model().graph, map->model().needs, truth, period_ns, map->model().limits,
                 event_messages),
        log_thread(notes, follower, recorder),
        events(notes, live_memory.served() ? &service.events : nullptr, overload),
        lines(kernel_gpio(), run_inputs.settings.gpio) {
    registry.add(std::move(map));
  }

  std::shared_ptr<MapVersion> first() const { return registry.find(1); }
  void account_for(const MapVersion& next);

  static void tell(const std::string& message);  // to standard error

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
  RunSummary summary() const;  // all threads have ended; but for the event log's hash

  RunInputs& inputs;
  MapTerms terms_of_next;
  LiveMemory& zones_memory;
  const Notifier& notifier;
  LiveOptions options;
  std::int64_t period_ns;
  SharedMap& shared;
  MapRegistry registry;
  LiveLoader loader;
  SpscQueue<LiveNote> notes;
  MapFollower follower;  // the log thread's
  EventLog log;
  RunRecording recording;
  std::optional<StateStore> state_store;
  std::optional<StateSaver> state_saver;
  const TruthTrack* truth;
  EventMessages event_messages;
  RunStatistics recorder;
  LogThread log_thread;
  OverloadCounters overload;
  Service service;
  EventFanOut events;
  LiveLines lines;
  Seqlock<LiveStatus> status;
  std::unique_ptr<LiveSource> source;
  std::unique_ptr<CanCapture> can_recorder;
  std::optional<MapSwitcher> maps;
  std::unique_ptr<ControlLoop> loop;
  std::optional<MapChange> change;
  Thread control_thread;
  std::atomic<bool> control_ended{false};
  std::atomic<int> lock_error{0};
};

}  // namespace zonepack
