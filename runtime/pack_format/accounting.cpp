// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/accounting.hpp"

#include <algorithm>

namespace zonepack {
namespace {

ByteCount ring_bytes(const fb::Ring& ring) {
  return kTableBytesPerRing + ring.points()->size() * kTableBytesPerVertex;
}

ByteCount table_bytes(const fb::Zone& zone) {
  const std::uint64_t text =
      zone.name()->size() + (zone.zone_type() == nullptr ? 0 : zone.zone_type()->size());
  ByteCount bytes = kTableBytesPerZone + text * kTableBytesPerNameByte + ring_bytes(*zone.outer());
  if (zone.holes() != nullptr) {
    for (const fb::Ring* hole : *zone.holes()) bytes += ring_bytes(*hole);
  }
  return bytes;
}

ByteCount table_bytes(const fb::Portal& portal) {
  return kTableBytesPerPortal + (portal.name() == nullptr ? 0 : portal.name()->size());
}

std::uint64_t chunks_of(const fb::Zone& zone) {
  std::uint64_t count = 0;
  for (const fb::PayloadBytes* payload : *zone.payloads()) count += payload->chunks();
  return count;
}

}  // namespace

MapCosts map_costs(const fb::Manifest& manifest, PayloadMask wanted) {
  MapCosts costs;
  ByteCount tables = kTableBytesPerMap;
  std::uint64_t most_chunks = 0;
  for (const fb::Zone* zone : *manifest.zones()) {
    costs.zone_slots.push_back(zone_slots(manifest, *zone, wanted));
    tables += table_bytes(*zone);
    most_chunks = std::max(most_chunks, chunks_of(*zone));
  }
  if (manifest.portals() != nullptr) {
    for (const fb::Portal* portal : *manifest.portals()) tables += table_bytes(*portal);
  }
  costs.fixed_bytes =
      tables + kReadBufferBytes + kIndexBytesPerPack + most_chunks * kIndexBytesPerChunk;
  return costs;
}

SmallestBudget smallest_budget(const fb::Manifest& manifest, const MapCosts& costs,
                               std::span<const ZoneId> pinned) {
  const std::vector<std::uint32_t>& slots = costs.zone_slots;
  std::vector<bool> is_pinned(slots.size(), false);
  std::uint64_t pinned_slots = 0;
  for (const ZoneId zone : pinned) {
    if (zone >= slots.size() || is_pinned[zone]) continue;
    is_pinned[zone] = true;
    pinned_slots += slots[zone];
  }
  const auto beside_pins = [&](ZoneId zone) {
    return is_pinned[zone] ? std::uint64_t{0} : std::uint64_t{slots[zone]};
  };
  SmallestBudget best;
  std::uint64_t most = 0;
  for (ZoneId zone = 0; zone < slots.size(); ++zone) {
    if (best.zone_a == kNoZone || beside_pins(zone) > most) {
      most = beside_pins(zone);
      best.zone_a = zone;
    }
  }
  if (manifest.portals() != nullptr) {
    for (const fb::Portal* portal : *manifest.portals()) {
      const std::uint64_t pair = beside_pins(portal->zone_a()) + beside_pins(portal->zone_b());
      if (pair > most || (pair == most && best.zone_b == kNoZone)) {
        most = pair;
        best.zone_a = portal->zone_a();
        best.zone_b = portal->zone_b();
      }
    }
  }
  best.slots = most + pinned_slots;
  best.bytes = charged_with(costs.fixed_bytes, best.slots);
  return best;
}

}  // namespace zonepack
