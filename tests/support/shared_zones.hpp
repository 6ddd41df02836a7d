// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "runtime/memory/shared_map.hpp"
#include "runtime/pack_format/zone_view.hpp"

namespace zonepack::test_support {

// What control and loader do to shared memory, in one thread: zones whose decoded chunks are put
// into slots, published and withdrawn.
class SharedZones {
 public:
  // Lays out the memory, of shared_map_bytes(zones, slots).
  SharedZones(std::span<std::byte> memory, std::uint32_t zones, std::uint32_t slots);

  // From now on uses only every other slot; no zone may be there yet.
  void leave_gaps();

  // The slots that chunks take.
  static std::uint32_t slots_for(std::span<const ChunkRef> chunks);

  // Takes slots and fills them, for a caller that publishes them itself.
  SlotChain fill(std::span<const ChunkRef> chunks);
  void give_back(SlotChain chain) { pool_.give_back(chain); }

  // Fills slots and publishes them; the zone must not be there. Returns its generation.
  std::uint32_t put(ZoneId zone, std::span<const ChunkRef> chunks);
  void remove(ZoneId zone);

  SharedMap& map() { return map_; }
  const SlotChain& chain(ZoneId zone) const { return chains_.at(zone); }
  SlotIndex next(SlotIndex slot) const { return pool_.next(slot); }
  std::uint32_t free_slots() const { return pool_.free_count(); }

 private:
  SharedMap map_;
  SlotPool pool_;
  SlotChain gaps_;
  std::map<ZoneId, SlotChain> chains_;
  std::map<ZoneId, std::uint32_t> generations_;
};

}  // namespace zonepack::test_support
