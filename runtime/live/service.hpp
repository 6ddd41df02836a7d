// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "platform/notify.hpp"
#include "platform/realtime.hpp"
#include "platform/spsc_queue.hpp"
#include "runtime/live/live_memory.hpp"
#include "runtime/serve/server.hpp"

namespace zonepack {

// The thread that serves other programs, and the queues between it and the control thread. It also
// tells the service manager's watchdog that the run is alive, as long as the control thread's
// cycles go on.
//
// Threads: open(), start() and stop() by the owner; the queues as their names say.
class Service {
 public:
  Service() : events(1024), commands(128), replies(256), poses(64) {}
  ~Service() { stop(); }

  // Starts to listen; false with a complete message in `fault`.
  bool open(const ServeSettings& settings, const Seqlock<LiveStatus>& status, LiveMemory& memory,
            const Catalog& catalog, const ZoneGraph& graph, std::span<const ZoneId> pinned,
            std::int64_t lease_ns, std::function<Result<std::uint64_t>(int fd)> dump,
            std::string& fault);
  Result<void> start(const Notifier& notifier, std::function<std::uint64_t()> cycles);
  void stop() noexcept;

  const LineBoard* lines = nullptr;  // told to those who ask; before open()
  SpscQueue<Event> events;           // control to server
  SpscQueue<Command> commands;       // server to control
  SpscQueue<CommandReply> replies;   // control to server
  SpscQueue<PoseCorrection> poses;   // server to control

 private:
  void run(const Notifier& notifier);
  void watch(const Notifier& notifier);

  std::unique_ptr<Server> server_;
  std::function<std::uint64_t()> cycles_;
  std::uint64_t cycles_seen_ = 0;
  std::int64_t told_ns_ = 0;
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
