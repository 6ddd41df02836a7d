// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/layout.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace zonepack::packer::tune {
namespace {

ByteCount ring_bytes(const Ring& ring) {
  return kTableBytesPerRing + ring.size() * kTableBytesPerVertex;
}

// As accounting.cpp counts a manifest's zone.
ByteCount table_bytes(const PlannedZone& zone) {
  ByteCount bytes = kTableBytesPerZone +
                    (zone.name.size() + zone.zone_type.size()) * kTableBytesPerNameByte +
                    ring_bytes(zone.polygon.outer);
  for (const Ring& hole : zone.polygon.holes) bytes += ring_bytes(hole);
  return bytes;
}

std::uint64_t slots_of(const TunedZone& zone) {
  return zone.pinned || !zone.loaded ? 0 : zone.cost.slots;
}

std::uint64_t pinned_slots(const Layout& layout) {
  std::uint64_t slots = 0;
  for (const TunedZone& zone : layout.zones) {
    if (zone.alive && zone.pinned && zone.loaded) slots += zone.cost.slots;
  }
  return slots;
}

}  // namespace

ByteCount Layout::fixed_bytes() const {
  ByteCount bytes = other_fixed_bytes;
  std::uint64_t chunks = 0;
  for (const TunedZone& zone : zones) {
    if (!zone.alive) continue;
    bytes += table_bytes(zone.zone);
    chunks = std::max(chunks, zone.cost.chunks);
  }
  for (const PlannedPortal& portal : portals) bytes += kTableBytesPerPortal + portal.name.size();
  return bytes + chunks * kIndexBytesPerChunk;
}

std::size_t Layout::living() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(zones, [](const TunedZone& zone) { return zone.alive; }));
}

ZonePlan Layout::plan() const {
  ZonePlan plan;
  std::vector<std::uint32_t> index(zones.size());
  for (std::size_t i = 0; i < zones.size(); ++i) {
    if (!zones[i].alive) continue;
    index[i] = static_cast<std::uint32_t>(plan.zones.size());
    plan.zones.push_back(zones[i].zone);
  }
  for (PlannedPortal portal : portals) {
    portal.zone_a = index[portal.zone_a];
    portal.zone_b = index[portal.zone_b];
    plan.portals.push_back(std::move(portal));
  }
  sort_by_name(plan);
  return plan;
}

DriveCost cost_of(std::span<const Visit> visits, const Layout& layout, std::uint64_t slots) {
  DriveCost cost;
  std::vector<std::uint32_t> held;  // the zone used last at the end
  std::uint64_t used = 0;
  for (const Visit& visit : visits) {
    const TunedZone& zone = layout.zones[visit.zone];
    if (zone.pinned || !zone.loaded) continue;
    const auto found = std::ranges::find(held, visit.zone);
    if (found != held.end()) {
      std::rotate(found, found + 1, held.end());
      continue;
    }
    while (!held.empty() && used + zone.cost.slots > slots) {
      used -= layout.zones[held.front()].cost.slots;
      held.erase(held.begin());
    }
    held.push_back(visit.zone);
    used += zone.cost.slots;
    cost += {1, zone.members.size(), zone.cost.stored};
  }
  return cost;
}

Smallest smallest_of(const Layout& layout) {
  Smallest smallest;
  std::pair<std::uint32_t, std::uint32_t> largest{0, 0};
  const auto offer = [&](std::uint64_t slots, std::uint32_t a, std::uint32_t b) {
    if (slots > smallest.pair_slots || smallest.pairs == 0) {
      smallest.pair_slots = slots;
      smallest.pairs = 0;
      largest = {a, b};
    }
    if (slots == smallest.pair_slots) ++smallest.pairs;
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const PlannedPortal& portal : layout.portals) {
    pairs.insert(std::minmax(portal.zone_a, portal.zone_b));
  }
  for (const auto& [a, b] : pairs) {
    offer(slots_of(layout.zones[a]) + slots_of(layout.zones[b]), a, b);
  }
  for (std::uint32_t i = 0; i < layout.zones.size(); ++i) {
    const TunedZone& zone = layout.zones[i];
    if (zone.alive && (smallest.pairs == 0 || slots_of(zone) > smallest.pair_slots)) {
      offer(slots_of(zone), i, i);
    }
  }
  smallest.bytes = charged_with(layout.fixed_bytes(), smallest.pair_slots + pinned_slots(layout));
  smallest.text = layout.zones[largest.first].zone.name;
  if (largest.second != largest.first) {
    smallest.text += " with " + layout.zones[largest.second].zone.name;
  }
  return smallest;
}

std::uint64_t room_in(const Layout& layout, const Smallest& smallest, ByteCount budget) {
  const std::uint64_t all = slots_within(budget, layout.fixed_bytes());
  const std::uint64_t pinned = pinned_slots(layout);
  return std::max(smallest.pair_slots, all > pinned ? all - pinned : 0);
}

}  // namespace zonepack::packer::tune
