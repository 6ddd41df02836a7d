// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/transitions_bytes.hpp"

#include <vector>

namespace zonepack {

ByteCount transitions_bytes(const MapCosts& costs) {
  std::vector<std::uint32_t> portals(costs.zone_slots.size());
  for (const auto& [a, b] : costs.neighbours) {
    ++portals[a];
    ++portals[b];
  }
  TransitionRoom room;
  for (const std::uint32_t count : portals) room.add(count);
  return room.bytes();
}

}  // namespace zonepack
