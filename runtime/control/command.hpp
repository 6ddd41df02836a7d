// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "platform/base/result.hpp"
#include "runtime/memory/residency.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// What another program asks of the control thread. A plain value: it is queued, recorded with the
// cycle that took it, and taken again from the recording.
struct Command {
  enum class Kind : std::uint8_t {
    kPin,        // zone: loaded, and not evicted until unpinned
    kUnpin,      // zone
    kFreeze,     // nothing is evicted
    kUnfreeze,   // zones are evicted again
    kLease,      // zone: a reader holds it, for at most the lease time
    kRelease,    // lease
    kRouteHint,  // route: the zones that a planned way leads through, in order; empty ends it
    kMapFreed,   // the tables of the map before the last change are gone
    // Of a localizer that searches the map:
    kLost,     // the pose is wrong or there is none: it is given up until fixes agree again
    kSeek,     // zone: while lost, the one to have in memory next; kNoZone: none
    kAskTurn,  // the robot is asked to turn on the spot: new views set similar places apart
  };
  static constexpr std::size_t kMostRoute = 64;

  Kind kind = Kind::kPin;
  std::uint32_t map = 0;  // number of the map that its zones belong to; 0: the one in use
  std::uint64_t id = 0;   // repeated in the reply
  ZoneId zone = kNoZone;
  Lease lease;
  std::uint32_t route_length = 0;
  std::array<ZoneId, kMostRoute> route{};
};

// The words of the event log and of recordings ("route_hint").
const char* to_string(Command::Kind kind) noexcept;

// Errors: kNotFound (no such zone; not resident), kNoRoom (pins and the largest pair would not fit
// together; too many pins).
struct CommandReply {
  std::uint64_t id = 0;
  std::uint32_t map = 0;  // number of the map that took it; 0: the one in use
  Error error;
  Lease lease;  // for kLease
};

}  // namespace zonepack
