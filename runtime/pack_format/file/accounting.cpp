// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/accounting.hpp"

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

// Marks by ZoneId; ignores ids beyond the last zone.
std::vector<bool> marked(std::span<const ZoneId> zones, std::size_t count) {
  std::vector<bool> marks(count, false);
  for (const ZoneId zone : zones) {
    if (zone < count) marks[zone] = true;
  }
  return marks;
}

}  // namespace

ChunkBytes chunk_bytes(const fb::Zone& zone, PayloadMask wanted) noexcept {
  const PayloadMask mask = payload_closure(wanted, zone.grid_needs_scan());
  ChunkBytes bytes;
  for (const fb::PayloadBytes* payload : *zone.payloads()) {
    if ((mask & mask_of(static_cast<fb::PayloadKind>(payload->kind()))) == 0) continue;
    bytes.stored += payload->stored();
    bytes.decoded += payload->decoded();
  }
  return bytes;
}

std::uint64_t chunk_count(const fb::Zone& zone) noexcept {
  std::uint64_t count = 0;
  for (const fb::PayloadBytes* payload : *zone.payloads()) count += payload->chunks();
  return count;
}

ByteCount table_bytes(const fb::Manifest& manifest) noexcept {
  ByteCount bytes = kTableBytesPerMap + kReadBufferBytes + kIndexBytesPerPack;
  std::uint64_t most_chunks = 0;
  for (const fb::Zone* zone : *manifest.zones()) {
    bytes += table_bytes(*zone);
    most_chunks = std::max(most_chunks, chunk_count(*zone));
  }
  if (manifest.portals() != nullptr) {
    for (const fb::Portal* portal : *manifest.portals()) bytes += table_bytes(*portal);
  }
  return bytes + most_chunks * kIndexBytesPerChunk;
}

MapCosts map_costs(const fb::Manifest& manifest, ByteCount file_bytes, PayloadMask wanted) {
  MapCosts costs;
  costs.fixed_bytes = table_bytes(manifest) + manifest_charge(file_bytes);
  costs.zone_slots.reserve(manifest.zones()->size());
  for (const fb::Zone* zone : *manifest.zones()) {
    costs.zone_slots.push_back(zone_slots(manifest, *zone, wanted));
  }
  if (manifest.portals() == nullptr) return costs;
  costs.neighbours.reserve(manifest.portals()->size());
  for (const fb::Portal* portal : *manifest.portals()) {
    costs.neighbours.emplace_back(portal->zone_a(), portal->zone_b());
  }
  return costs;
}

LargestPair largest_pair(std::span<const std::uint32_t> amounts,
                         std::span<const ZonePair> neighbours, std::span<const ZoneId> pinned) {
  const std::vector<bool> is_pinned = marked(pinned, amounts.size());
  const auto beside_pins = [&](ZoneId zone) {
    return is_pinned[zone] ? std::uint64_t{0} : std::uint64_t{amounts[zone]};
  };
  LargestPair most;
  for (ZoneId zone = 0; zone < amounts.size(); ++zone) {
    if (most.zone_a == kNoZone || beside_pins(zone) > most.amount) {
      most = {beside_pins(zone), zone, kNoZone};
    }
  }
  for (const auto& [a, b] : neighbours) {
    const std::uint64_t both = beside_pins(a) + beside_pins(b);
    if (both > most.amount || (both == most.amount && most.zone_b == kNoZone)) most = {both, a, b};
  }
  return most;
}

SmallestBudget smallest_budget(const MapCosts& costs, std::span<const ZoneId> pinned) {
  SmallestBudget best;
  best.pair = largest_pair(costs.zone_slots, costs.neighbours, pinned);
  best.slots = best.pair.amount;
  const std::vector<bool> is_pinned = marked(pinned, costs.zone_slots.size());
  for (ZoneId zone = 0; zone < is_pinned.size(); ++zone) {
    if (is_pinned[zone]) best.slots += costs.zone_slots[zone];
  }
  best.bytes = charged_with(costs.fixed_bytes, best.slots);
  return best;
}

}  // namespace zonepack
