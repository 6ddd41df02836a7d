// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/accounting.hpp"

#include <algorithm>

namespace zonepack {
namespace {

std::uint64_t vertices_of(const fb::Zone& zone) {
  std::uint64_t count = zone.outer()->points()->size();
  if (zone.holes() != nullptr) {
    for (const fb::Ring* hole : *zone.holes()) count += hole->points()->size();
  }
  return count;
}

std::uint64_t chunks_of(const fb::Zone& zone) {
  std::uint64_t count = 0;
  for (const fb::PayloadBytes* payload : *zone.payloads()) count += payload->chunks();
  return count;
}

}  // namespace

MapCosts map_costs(const fb::Manifest& manifest, PayloadMask wanted) {
  MapCosts costs;
  std::uint64_t vertices = 0;
  std::uint64_t most_chunks = 0;
  for (const fb::Zone* zone : *manifest.zones()) {
    costs.zone_slots.push_back(zone_slots(manifest, *zone, wanted));
    vertices += vertices_of(*zone);
    most_chunks = std::max(most_chunks, chunks_of(*zone));
  }
  const std::uint64_t portals = manifest.portals() == nullptr ? 0 : manifest.portals()->size();
  costs.fixed_bytes = kTableBytesPerMap + kReadBufferBytes + kIndexBytesPerPack +
                      most_chunks * kIndexBytesPerChunk +
                      manifest.zones()->size() * kTableBytesPerZone +
                      vertices * kTableBytesPerVertex + portals * kTableBytesPerPortal;
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
