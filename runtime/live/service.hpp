// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "platform/memory/spsc_queue.hpp"
#include "platform/process/notify.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/live/cycle/live_memory.hpp"
#include "runtime/run/maps/map_version.hpp"
#include "runtime/serve/server.hpp"

namespace zonepack {

// What runs, for those who ask.
struct BuildInfo {
  std::string release = "unknown";  // "0.1.0"
  std::string commit = "unknown";
};

// The thread that serves other programs, and the queues between it and the control thread. It also
// reports to the service manager's watchdog that the run is alive, as long as the control thread's
// cycles go on.
//
// Threads: open(), start() and stop() by the owner; the queues as their names say.
class Service {
 public:
  Service() : events(1024), commands(128), replies(256), poses(64) {}
  ~Service() { stop(); }

  // Starts to listen.
  Outcome<void> open(const ServeSettings& settings, const Seqlock<LiveStatus>& status,
                     LiveMemory& memory, std::shared_ptr<const MapVersion> map,
                     std::function<Result<std::uint64_t>(BoundedWriter& to)> dump,
                     const BuildInfo& build);

  // A change of map, by one thread that asks until the answer is true. Before the offer: the server
  // knows the map. After it: the server has let go of this one.
  bool ready_for(const std::shared_ptr<const MapVersion>& next);
  bool done_with(std::uint32_t map);

  Result<void> start(const Notifier& notifier, std::function<std::uint64_t()> cycles);
  void stop() noexcept;

  const LineBoard* lines = nullptr;  // shown to those who ask; before open()
  SpscQueue<Event> events;           // control to server
  SpscQueue<Command> commands;       // server to control
  SpscQueue<CommandReply> replies;   // control to server
  SpscQueue<PoseCorrection> poses;   // server to control

 private:
  void run(const Notifier& notifier);
  void watch(const Notifier& notifier);
  void change_maps();

  // The server's thread holds the maps that the server refers to.
  std::shared_ptr<const MapVersion> served_, offered_;
  std::mutex mutex_;                          // of what follows
  std::shared_ptr<const MapVersion> coming_;  // asked for
  std::uint32_t known_ = 0;                   // the last one that the server knows of
  std::uint32_t going_ = 0, gone_ = 0;        // asked to be let go of; let go of last
  std::uint32_t asked_to_go_ = 0;             // a turn ago: its events were taken since
  std::unique_ptr<Server> server_;
  std::function<std::uint64_t()> cycles_;
  std::uint64_t cycles_seen_ = 0;
  std::int64_t told_ns_ = 0;
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
