// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/manifest_file.hpp"

#include <cstring>

namespace zonepack {

Digest32 manifest_digest(ByteSpan file) noexcept {
  ManifestTail tail;
  std::memcpy(&tail, file.data() + file.size() - sizeof tail, sizeof tail);
  return tail.digest;
}

Polygon polygon_of(const fb::Zone& zone) {
  const auto ring_of = [](const fb::Ring& ring) {
    Ring points;
    points.reserve(ring.points()->size());
    for (const fb::Point* p : *ring.points()) points.push_back({p->x(), p->y()});
    return points;
  };
  Polygon polygon{ring_of(*zone.outer()), {}};
  if (zone.holes() != nullptr) {
    for (const fb::Ring* hole : *zone.holes()) polygon.holes.push_back(ring_of(*hole));
  }
  return polygon;
}

std::uint32_t slot_table_index(PayloadMask wanted, PayloadMask packed) noexcept {
  std::uint32_t index = 0;
  std::uint32_t bit = 1;
  for (PayloadMask rest = packed & ~kCoreOnly; rest != 0; rest &= rest - 1) {
    if ((wanted & rest & (~rest + 1)) != 0) index |= bit;
    bit <<= 1;
  }
  return index;
}

std::uint32_t zone_slots(const fb::Manifest& manifest, const fb::Zone& zone,
                         PayloadMask wanted) noexcept {
  const PayloadMask mask = payload_closure(wanted, zone.grid_needs_scan());
  return zone.slots()->Get(slot_table_index(mask, manifest.payload_mask()));
}

}  // namespace zonepack
