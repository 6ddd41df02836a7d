// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/control/event.hpp"
#include "runtime/protocol/messages.hpp"
#include "runtime/run/figures/line_board.hpp"
#include "runtime/run/figures/live_status.hpp"
#include "runtime/serve/localizer_board.hpp"
#include "runtime/serve/served_map.hpp"
#include "runtime/zones/route.hpp"

// Answers to questions, as messages. Requests come from outside, so every number is checked against
// its bound; one that cannot be answered gets a fault. No message is longer than kMostMessageBytes.
namespace zonepack {

// What the server counts about itself.
struct ServerCounters {
  std::uint64_t requests = 0;
  std::uint64_t clients_refused = 0;  // there were too many
  std::uint64_t clients_dropped = 0;  // for not reading, or not saying hello
  std::uint64_t throttled = 0;        // times that a request waited for its client's allowance
  std::uint64_t malformed = 0;        // bytes that were not a message
  std::uint64_t events_undelivered = 0;
  std::uint64_t not_keeping_up = 0;  // events of that kind
  std::uint64_t map_changes = 0, map_refusals = 0;
  std::uint32_t clients = 0, leases = 0;
  std::int64_t uptime_ns = 0;
};

using Message = std::span<const std::byte>;

Message answer_status(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                      const LiveStatus& status, const ServerCounters& counters,
                      const LineBoard* lines = nullptr, const LocalizerBoard* localizers = nullptr);
Message answer_zones(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                     std::uint32_t first, bool active_only = false);
Message answer_outlines(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                        std::uint32_t first);
Message answer_zone(MessageBuilder& to, std::uint64_t id, const ServedMap& map, ZoneId zone);
Message answer_changes(MessageBuilder& to, std::uint64_t id, const ServedMap& map,
                       std::uint64_t since);
Message answer_signatures(MessageBuilder& to, std::uint64_t id, ServedMap& map, ZoneId zone,
                          std::uint32_t first);
Message answer_nearest(MessageBuilder& to, std::uint64_t id, ServedMap& map,
                       const wire::AskNearest& ask);
Message answer_pose(MessageBuilder& to, std::uint64_t id, const LiveStatus& status);
Message answer_route(MessageBuilder& to, std::uint64_t id, const ServedMap& map, const Route& route,
                     bool hinted);

// As many events as fit, which are then taken off the front of `events`.
Message events_notice(MessageBuilder& to, const ServedMap& map, std::span<const Event>& events);

// The fault for an error of the control thread or of reading; and, for a zone that does not exist,
// one that names it.
wire::Fault fault_of(const Error& error) noexcept;
Message no_such_zone(MessageBuilder& to, std::uint64_t id, std::uint32_t zone,
                     const flatbuffers::String* name);

}  // namespace zonepack
