// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "platform/memory/spsc_queue.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/live/messages/live_notes.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

// The thread that does what may take its time: it keeps the account of the run, writes events, and
// carries out regular tasks of others (recordings), so that neither the control thread nor the
// server waits for a disk.
//
// Threads: the run's account and all tasks belong to the log thread between start() and stop().
class LogThread {
 public:
  // Both must outlive this object.
  LogThread(SpscQueue<LiveNote>& notes, Run& run) : notes_(notes), run_(run) {}
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
  Run& run_;
  std::vector<std::function<void()>> tasks_;
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
