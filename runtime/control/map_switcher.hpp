// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "runtime/control/cycle.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/memory/zone_directory.hpp"

namespace zonepack {

// A map in use, or prepared for use: all of it outlives its use. A slower thread prepares it; from
// the offer until it is given back only the control thread touches it.
struct MapInUse {
  const Catalog& catalog;
  const ZoneGraph& graph;
  std::span<const ZoneNeed> needs;
  Residency& memory;
  Cycle& cycle;                       // of this memory
  std::uint32_t number = 1;           // in the run
  std::uint32_t slots = kNoSlot - 1;  // that exist, however many the budget allows
};

// The cycle over the map in use, and the change to another version of it while the robot drives:
//
//   1. nothing new is loaded; a load under way ends; zones but the robot's own and those that the
//      new map has with the same pack are evicted, at most one a cycle; then room for the new map's
//      tables and its zone at the robot's pose is set aside, for which more of them may have to go
//   2. that zone is loaded from the new map, unless it is one that is kept
//   3. between two cycles, the new map replaces the old one, pose and odometry continue, and zones
//      that are kept become the new map's, in their order of use, without being read again; room
//      for the old one's tables stays set aside until the command kMapFreed says that they are gone
//
// If there is no room, eviction is frozen, or the zone cannot be loaded (within kMostWait_ns), the
// old map stays, its zones are loaded again, and the event says why. The budget holds throughout.
//
// Invariant: as Cycle.
// Real-time: as Cycle.
// Threads: as Cycle.
class MapSwitcher {
 public:
  static constexpr std::int64_t kMostWait_ns = 30'000'000'000;
  // Of zones that both maps have, so many stay; the others are loaded again when wanted.
  static constexpr std::size_t kMostKept = 64;

  // Both outlive this object; `directory` may be null.
  MapSwitcher(MapInUse& map, ZoneLoader& loader, ZoneDirectory* directory) noexcept
      : map_(&map), loader_(loader), directory_(directory) {}

  // Runs one cycle. The loader's results for a map on offer are taken out of `input.loads`. An
  // offer with a fault in the input becomes an event; one without was made by offer().
  const CycleState& run(const CycleInput& input) noexcept;

  // Offers another map; before a run(). False while another is on offer.
  bool offer(MapInUse& next) noexcept;

  // The map that is no longer used: the one before a change, or an offer that was refused; null
  // when there is none. Each is returned once.
  MapInUse* take_unused() noexcept { return std::exchange(unused_, nullptr); }

  MapInUse& map() noexcept { return *map_; }
  const MapInUse& map() const noexcept { return *map_; }
  bool changing() const noexcept { return step_ != Step::kNone; }

 private:
  enum class Step : std::uint8_t { kNone, kMakingRoom, kLoading };

  void begin(std::int64_t now_ns) noexcept;
  void make_room() noexcept;
  bool drop_one() noexcept;
  ZoneId twin_of(ZoneId zone) const noexcept;
  bool keeps(ZoneId zone) noexcept;
  bool drop_kept() noexcept;
  bool room_for(ZoneNeed need) noexcept;
  bool keeps_twin(ZoneId of_next) const noexcept;
  std::span<const ZoneId> kept() const noexcept { return {kept_zones_.data(), kept_count_}; }
  void hand_over_kept() noexcept;
  void take_load(const LoadResult& result) noexcept;
  void change(const SlotChain& slots) noexcept;
  void refuse(const char* reason) noexcept;

  MapInUse* map_;
  ZoneLoader& loader_;
  ZoneDirectory* directory_;
  MapInUse* next_ = nullptr;
  MapInUse* unused_ = nullptr;
  Step step_ = Step::kNone;
  ZoneId zone_ = kNoZone;  // of the next map, at the robot's pose
  ZoneId own_ = kNoZone;   // of the map in use: the robot's own when the change began
  bool keeping_ = false;   // zones that both maps have
  bool loads_ = false;     // zone_ is not one that is kept
  std::array<ZoneId, kMostKept> kept_zones_{};  // of the map in use, ascending
  std::size_t kept_count_ = 0;
  struct HandedOver {
    ZoneId zone = kNoZone;  // of the next map
    SlotChain slots;
  };
  std::array<HandedOver, kMostKept> handed_over_{};  // least recently used first
  ZoneId looked_at_ = 0;  // zones before this one are evicted, except own_ and kept ones
  std::int64_t begun_ns_ = 0;
};

}  // namespace zonepack
