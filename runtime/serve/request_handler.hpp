// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "platform/process/local_socket.hpp"
#include "platform/process/slow_job.hpp"
#include "runtime/serve/answers.hpp"
#include "runtime/serve/command_router.hpp"
#include "runtime/serve/localizer_board.hpp"
#include "runtime/serve/served_map.hpp"
#include "runtime/serve/server_ports.hpp"
#include "runtime/serve/session.hpp"

namespace zonepack {

// Does what a request asks, or passes it on: to the control thread, whose reply settle() passes
// back, or to the thread that writes a recording.
//
// Threads: one, the server's.
class RequestHandler {
 public:
  RequestHandler(const ServerPorts& ports, std::uint32_t requests_per_s, ServerCounters& counters);

  // A request as it came, not yet checked.
  void take(Session& from, LocalSocket::Received& received, Message bytes, ServedMap& map,
            std::int64_t monotonic_ns);

  CommandRouter& router() noexcept { return router_; }

  // A client's connection has ended: so do its leases and its report.
  void client_gone(CommandRouter::ClientKey client) {
    router_.client_gone(client);
    localizers_.gone(client);
  }

  // Sends `to` the outcome of its command.
  void deliver(Session& to, const CommandRouter::Settled& settled) const;

  // The requested recording is written.
  struct Dump {
    CommandRouter::ClientKey client = 0;
    std::uint64_t request_id = 0;
    Result<std::uint64_t> bytes;
  };
  std::optional<Dump> poll_dump(std::int64_t monotonic_ns);
  // Ends the writing of a recording, if one is under way; false when it has not ended in time.
  bool stop_dump(std::int64_t until_monotonic_ns) noexcept;
  static void deliver(Session& to, const Dump& dump);

  bool busy() const noexcept { return router_.pending() > 0 || dump_.running(); }

 private:
  // What stays the same while one request is handled.
  struct Call {
    Session& from;
    const wire::Request& request;
    LocalSocket::Received& received;
    ServedMap& map;
    std::int64_t monotonic_ns;
    std::uint64_t id() const noexcept { return request.id(); }
  };

  void greet(const Call& call);
  void handle(const Call& call);
  bool look(const Call& call);
  void subscribe(const Call& call);
  void send_signatures(const Call& call);
  void plan(const Call& call);
  void command(const Call& call, Command command);
  void command_on_zone(const Call& call, Command::Kind kind, std::uint32_t zone,
                       const flatbuffers::String* name);
  void hint(const Call& call);
  void take_pose(const Call& call);
  void take_report(const Call& call);
  void start_dump(const Call& call);
  static void refuse(const Call& call, wire::Fault fault, std::string_view text = {});

  const ServerPorts& ports_;
  const std::uint32_t requests_per_s_;
  ServerCounters& counters_;
  CommandRouter router_;
  LocalizerBoard localizers_;
  std::uint64_t dump_request_ = 0;
  CommandRouter::ClientKey dump_client_ = 0;
  void end_dump() noexcept;

  std::atomic<bool> dump_cancelled_{false};
  std::int64_t dump_began_ns_ = 0;  // CLOCK_MONOTONIC
  SlowJob dump_{"zoned-dump"};      // destroyed first: it uses the above
};

}  // namespace zonepack
