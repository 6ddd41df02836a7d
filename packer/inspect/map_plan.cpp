// SPDX-License-Identifier: Apache-2.0
#include "packer/inspect/map_plan.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include "runtime/pack_format/file/transitions_bytes.hpp"

namespace zonepack::packer {
namespace {

// Each pair once, however many portals join it.
std::set<ZonePair> pairs_of(const MapCosts& costs) {
  std::set<ZonePair> pairs;
  for (const auto& [a, b] : costs.neighbours) pairs.insert(std::minmax(a, b));
  return pairs;
}

BudgetPlan plan_budget(const MapCosts& costs, const MapPlan& plan, ByteCount bytes) {
  BudgetPlan budget;
  budget.bytes = bytes;
  budget.suffices = bytes >= plan.smallest.bytes;
  budget.slots = slots_within(bytes, plan.fixed_bytes);
  std::uint64_t pinned = 0;
  std::vector<std::uint64_t> others;
  for (const ZoneCost& zone : plan.zones) {
    if (zone.pinned) {
      pinned += zone.slots;
    } else {
      others.push_back(zone.slots);
    }
  }
  const auto beside_pins = [&](ZoneId zone) {
    return plan.zones[zone].pinned ? std::uint64_t{0} : std::uint64_t{plan.zones[zone].slots};
  };
  const auto fits = [&](std::uint64_t slots) {
    return bytes >= plan.fixed_bytes && pinned + slots <= budget.slots;
  };
  for (ZoneId zone = 0; zone < plan.zones.size(); ++zone) {
    if (!fits(beside_pins(zone))) budget.zones_without_room.push_back(zone);
  }
  for (const auto& [a, b] : pairs_of(costs)) {
    const bool alone = fits(beside_pins(a)) && fits(beside_pins(b));
    if (alone && !fits(beside_pins(a) + beside_pins(b)))
      budget.pairs_without_room.push_back({a, b});
  }
  std::sort(others.begin(), others.end(), std::greater<>());
  std::uint64_t sum = 0;
  for (const std::uint64_t slots : others) {
    sum += slots;
    if (!fits(sum)) break;
    ++budget.largest_zones_at_once;
  }
  budget.whole_map = fits(0) && budget.largest_zones_at_once == others.size();
  if (fits(0)) budget.largest_zones_at_once += plan.zones.size() - others.size();
  return budget;
}

}  // namespace

MapPlan plan_map(const fb::Manifest& manifest, PayloadMask payload, std::span<const ZoneId> pinned,
                 std::optional<ByteCount> budget, ByteCount file_bytes,
                 const std::vector<std::string>& layers) {
  MapCosts costs = map_costs(manifest, file_bytes, payload);
  const auto loaded = [&](ZoneId id) {
    const std::string layer = flatbuffers::GetString(manifest.zones()->Get(id)->layer());
    return layers.empty() || layer.empty() || std::ranges::find(layers, layer) != layers.end();
  };
  for (ZoneId id = 0; id < costs.zone_slots.size(); ++id) {
    if (!loaded(id)) costs.zone_slots[id] = 0;
  }
  MapPlan plan;
  plan.payload = payload;
  plan.fixed_bytes = costs.fixed_bytes;
  plan.transitions_bytes = transitions_bytes(costs);
  plan.smallest = smallest_budget(costs, pinned);
  std::uint64_t largest = 0;
  for (ZoneId id = 0; id < manifest.zones()->size(); ++id) {
    const fb::Zone& zone = *manifest.zones()->Get(id);
    const std::uint32_t slots = costs.zone_slots[id];
    const bool is_pinned = std::find(pinned.begin(), pinned.end(), id) != pinned.end();
    plan.zones.push_back({.name = zone.name()->str(),
                          .layer = flatbuffers::GetString(zone.layer()),
                          .signatures = zone.signatures(),
                          .slots = slots,
                          .charged_bytes = slots * kSlotBytes,
                          .stored_bytes = chunk_bytes(zone, payload).stored,
                          .pinned = is_pinned,
                          .loaded = loaded(id)});
    largest = std::max<std::uint64_t>(largest, slots);
  }
  plan.live_change_bytes = plan.smallest.bytes + charged_with(plan.fixed_bytes, largest);
  if (budget) plan.budget = plan_budget(costs, plan, *budget);
  return plan;
}

}  // namespace zonepack::packer
