// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "platform/realtime.hpp"
#include "platform/spsc_queue.hpp"
#include "runtime/live/live_notes.hpp"
#include "runtime/run/map_version.hpp"
#include "runtime/run/run_statistics.hpp"

namespace zonepack {

// The thread that does what may take its time: it keeps the account of the run, writes events, and
// does what others give it to do regularly (recordings, saved state), so that neither the control
// thread nor the server waits for a disk.
//
// Threads: the recorder, and all tasks, are the log thread's between start() and stop().
class LogThread {
 public:
  // maps: is told of each note's before the recorder gets it. All outlive this object.
  LogThread(SpscQueue<LiveNote>& notes, MapFollower& maps, RunStatistics& recorder)
      : notes_(notes), maps_(maps), recorder_(recorder) {}
  ~LogThread() { stop(); }

  // A task is called every few milliseconds, and once more while stopping. Before start().
  void add_task(std::function<void()> task) { tasks_.push_back(std::move(task)); }

  Result<void> start();
  // Takes what is left in the queue, then ends the thread.
  void stop() noexcept;

 private:
  void run();
  void drain();

  SpscQueue<LiveNote>& notes_;
  MapFollower& maps_;
  RunStatistics& recorder_;
  std::vector<std::function<void()>> tasks_;
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
