// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "platform/base/failure.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "platform/process/notify.hpp"
#include "runtime/live/cycle/live_control.hpp"
#include "runtime/live/cycle/live_memory.hpp"
#include "runtime/live/habit_keeper.hpp"
#include "runtime/live/messages/event_messages.hpp"
#include "runtime/live/messages/live_notes.hpp"
#include "runtime/live/messages/log_thread.hpp"
#include "runtime/live/run_recording.hpp"
#include "runtime/live/service.hpp"
#include "runtime/run/run.hpp"
#include "runtime/settings/settings.hpp"
#include "runtime/state/state_saver.hpp"

namespace zonepack {

// All that watches a live run and may take its time: the log thread with event log, messages and
// recordings; the saved state; the service. They see what the control thread puts into queues and
// into its status, and it never waits for them.
//
// Threads: events is the control thread's; each member's own contract; all else the owner's.
class LiveObservers {
 public:
  // All of it must outlive this object. quiet: only warnings are printed.
  LiveObservers(Run& run, LiveControl& control, LiveMemory& memory, bool quiet);
  ~LiveObservers();

  // What the run learns; may be null. Before all that follows.
  void keep_habits(std::unique_ptr<HabitKeeper> keeper);

  // Reads what the robot knew when it stopped, and arranges to save what it knows. folder: empty:
  // nothing is kept. The start that was saved, if any; a chosen start goes before it.
  std::optional<RunStart> restore(const std::string& folder, const PoseFilterSettings& pose,
                                  std::int64_t now_ns);
  Outcome<void> open_recording(const RecordingChoice& choice, const RecordingPreface& preface,
                               std::uint32_t most_frames);
  // Starts to listen, if the memory is served.
  Outcome<void> open_service(const ServeSettings& settings, const LineBoard& lines,
                             const BuildInfo& build);

  // Starts the threads that wait for control's notes; before control.
  Outcome<void> start();
  // Starts to serve; after control.
  Outcome<void> serve(const Notifier& notifier);
  void stop_serving() noexcept { service.stop(); }
  // After control has ended: takes what is left in the queue, and ends the threads.
  void stop();

  SpscQueue<LiveNote> notes;
  Service service;
  EventFanOut events;  // from control to notes and service
  RunRecording recording;
  LogThread log_thread;

 private:
  Run& run_;
  LiveControl& control_;
  LiveMemory& memory_;
  EventMessages messages_;
  std::unique_ptr<HabitKeeper> habits_;
  std::optional<StateStore> state_store_;
  std::optional<StateSaver> state_saver_;
};

}  // namespace zonepack
