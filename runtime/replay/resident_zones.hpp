// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/memory/zone_directory.hpp"
#include "runtime/pack_format/zone_view.hpp"
#include "runtime/replay/pack_filler.hpp"

namespace zonepack {

// The zones that a replay's cycle holds at this moment, read in place in its slots. What is not
// resident is not here, whatever the map's folder holds.
//
// Threads: the replay's.
// Memory: the tables of views of resident zones; the signatures lie in the filler's arena.
class ResidentZones final : public ZoneDirectory {
 public:
  // Null: there are no packs, and no zone can be read. Must outlive this object.
  explicit ResidentZones(const PackFiller* filler) : filler_(filler) {}

  struct Zone {
    ZoneId zone = kNoZone;
    std::uint32_t generation = 0;  // another one: it was loaded again meanwhile
    ZoneView view;
  };
  // By the time at which they became resident. Valid until the next cycle.
  const std::vector<Zone>& zones() const noexcept { return zones_; }

  void publish(ZoneId zone, std::uint32_t generation, const SlotChain& slots) noexcept override;
  void withdraw(ZoneId zone) noexcept override;
  Result<void> begin_map(std::uint32_t zones) noexcept override;

 private:
  const PackFiller* filler_;
  std::vector<Zone> zones_;
};

}  // namespace zonepack
