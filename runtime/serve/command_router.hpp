// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "platform/memory/spsc_queue.hpp"
#include "runtime/control/command.hpp"
#include "runtime/serve/zone_table.hpp"

namespace zonepack {

// Passes clients' commands to the control thread and its replies back, and remembers who holds
// which lease, so that a client's leases end with it.
//
// It never waits for the control thread: a full queue refuses the command, and a reply that does
// not come within kPatience_ns is given up.
//
// Threads: one, the server's.
// Bounds: kMostPending commands, kMostLeases leases.
class CommandRouter {
 public:
  static constexpr std::size_t kMostPending = 256;
  static constexpr std::size_t kMostLeases = 1024;
  static constexpr std::int64_t kPatience_ns = 2'000'000'000;

  using ClientKey = std::uint64_t;  // never used twice

  // Who asked, what for, and the outcome. kBusy: no answer in time.
  struct Settled {
    ClientKey client = 0;
    std::uint64_t request_id = 0;
    Command::Kind kind = Command::Kind::kPin;
    CommandReply reply;
  };

  CommandRouter(SpscQueue<Command>& commands, SpscQueue<CommandReply>& replies);

  // The table of the map in use, which is updated with pins and leases, and the map's number.
  void use(ZoneTable& zones, std::uint32_t map) noexcept {
    zones_ = &zones;
    map_ = map;
  }

  // kBusy: too much is under way; kTooLarge: too many leases; kNotFound: a release of a lease that
  // is not this client's.
  Result<void> post(ClientKey client, std::uint64_t request_id, Command command,
                    std::int64_t monotonic_ns);

  // Passes on the replies that came. run_ns: the run's clock, by which leases end after lease_ns.
  void settle(std::int64_t monotonic_ns, std::int64_t run_ns, std::int64_t lease_ns,
              const std::function<void(const Settled&)>& deliver);

  // Releases what the client holds or is yet to get.
  void client_gone(ClientKey client);

  // Zone numbers mean other zones from here on: leases end, replies under way are refused.
  void map_changed();

  std::size_t pending() const noexcept { return pending_.size(); }
  std::size_t leases() const noexcept { return held_.size(); }

 private:
  struct Pending {
    Settled settled;
    ZoneId zone = kNoZone;
    std::uint64_t command_id = 0;
    std::int64_t give_up_ns = 0;
  };
  struct Held {
    ClientKey client = 0;
    Lease lease;
    std::int64_t ends_ns = 0;
  };

  bool hand_over(Command& command) noexcept;
  void note(const Pending& pending, const CommandReply& reply, std::int64_t ends_ns);
  void drop_lease(std::size_t index);
  void release_later(const Lease& lease);

  SpscQueue<Command>& commands_;
  SpscQueue<CommandReply>& replies_;
  ZoneTable* zones_ = nullptr;
  std::uint32_t map_ = 0;
  std::vector<Pending> pending_;
  std::vector<Held> held_;
  std::vector<Lease> to_release_;
  std::uint64_t last_id_ = 0;
};

}  // namespace zonepack
