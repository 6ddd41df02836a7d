// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/process/local_socket.hpp"
#include "platform/process/poller.hpp"
#include "runtime/serve/answers.hpp"
#include "runtime/serve/request_handler.hpp"
#include "runtime/serve/served_map.hpp"
#include "runtime/serve/server_ports.hpp"
#include "runtime/serve/session.hpp"
#include "runtime/settings/serve_settings.hpp"

namespace zonepack {

// Serves other programs over local sockets (PROTOCOL.md). The control thread leaves a status and
// events for it and takes commands and poses when it likes: nothing that a client does or fails to
// do holds it up.
//
// Bounds: settings.clients at once; accepting kMostAccepts and, for each client, kMostRequests a
// turn; what Session, CommandRouter and NodeStore state.
// Memory: below 116 KiB, and for each client that does not read up to Session::kMostWaiting here
// and kKernelBytes and one message in the kernel. Tables that grow with the map are charged with it
// (table_bytes).
// Threads: all calls by one, except stop() by any. Does not throw, but may run out of memory.
class Server {
 public:
  static constexpr int kTurn_ms = 10;          // how late an event, a pose or a reply is at most,
  static constexpr int kTurnWhenAsked_ms = 2;  // and while a command is under way
  static constexpr std::size_t kMostAccepts = 16;
  static constexpr std::size_t kMostRequests = 16;

  // Starts to listen; never null. `pinned`: zones pinned from the start.
  static Outcome<std::unique_ptr<Server>> open(const ServeSettings& settings,
                                               const ServerPorts& ports, const Catalog& catalog,
                                               const ZoneGraph& graph,
                                               std::span<const ZoneId> pinned);
  ~Server();

  // One turn: waits for something to do, at most timeout_ms, and does it.
  void turn(int timeout_ms);

  // Turns until stop().
  void run();
  void stop() noexcept;

  // After the last turn: ends the writing of a recording that a client asked for; false when its
  // thread has not ended by then, and the destructor would wait for it.
  bool stop_dump(std::int64_t until_monotonic_ns) noexcept {
    return handler_.stop_dump(until_monotonic_ns);
  }

  // A map that the run is about to be offered, and its number there. It replaces the one in use
  // with its first event, and is forgotten at map_refused. Clients are notified; leases end. map()
  // is the one being served.
  void offer_map(std::uint32_t serial, const Catalog& catalog, const ZoneGraph& graph,
                 std::span<const ZoneId> pinned);

  // The run no longer uses this map, and all its events were taken: the server stops using it too,
  // even if the event that said so was lost.
  void forget_map(std::uint32_t serial);

  // Posts a command of the daemon itself through the server's queue. False: no room now.
  bool post(const Command& command);

  const ServerCounters& counters() const noexcept { return counters_; }
  const ServedMap& map() const noexcept { return *map_; }

  // What a map adds: the tables of zones and of signatures' positions.
  static ByteCount table_bytes(std::size_t zones, std::uint64_t signatures) noexcept {
    return ZoneTable::table_bytes(zones) + NodeStore::table_bytes(zones, signatures);
  }

 private:
  struct Listener {
    LocalListener socket;
    bool looking_only = false;
    std::int64_t paused_until_ns = 0;  // 0: accepting
  };

  Server(const ServeSettings& settings, const ServerPorts& ports, Poller poller);
  Outcome<void> add_listener(const std::string& path, const std::string& mode, bool looking_only);
  void notify_subscribers();
  void take_events();
  void change_map();
  void settle();
  void accept(std::size_t listener);
  void pause_or_resume(Listener& listener, std::size_t token);
  void receive(Session& session);
  void send_poses();
  void tidy();
  Session* session_of(std::uint64_t key) noexcept;

  const ServeSettings settings_;
  const ServerPorts ports_;
  Poller poller_;
  std::vector<Listener> listeners_;
  std::vector<std::unique_ptr<Session>> sessions_;  // null: a free place
  std::unique_ptr<ServedMap> map_;
  std::unique_ptr<ServedMap> offered_;
  ServerCounters counters_;
  RequestHandler handler_;
  std::vector<Event> events_;          // of this turn
  std::vector<std::uint64_t> buffer_;  // a request on its way
  std::uint64_t last_key_ = 0;
  std::uint64_t lost_events_ = 0;  // as of the last status
  std::int64_t now_ns_ = 0;        // CLOCK_MONOTONIC, of this turn
  std::int64_t started_ns_ = 0;
  std::atomic<bool> stop_{false};
};

}  // namespace zonepack
