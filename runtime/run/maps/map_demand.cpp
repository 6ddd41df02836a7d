// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/maps/map_demand.hpp"

#include <algorithm>

#include "platform/base/shell_word.hpp"
#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack {
namespace {

NeedSum pair_of(const CatalogZone& a, const CatalogZone& b) {
  return {std::uint64_t{a.slots} + b.slots, std::uint64_t{a.signatures} + b.signatures};
}

std::vector<std::uint32_t> signatures_of(const Catalog& catalog) {
  std::vector<std::uint32_t> signatures;
  for (const CatalogZone& zone : catalog.zones) signatures.push_back(zone.signatures);
  return signatures;
}

}  // namespace

ZoneGraph graph_of(const Catalog& catalog) {
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  zones.reserve(catalog.zones.size());
  portals.reserve(catalog.portals.size());
  for (const CatalogZone& zone : catalog.zones)
    zones.push_back({zone.name, zone.polygon, zone.loadable});
  for (const CatalogPortal& portal : catalog.portals) {
    portals.push_back({portal.zone_a, portal.zone_b, portal.segment});
  }
  return ZoneGraph(std::move(zones), portals);
}

std::vector<ZoneNeed> needs_of(const Catalog& catalog) {
  std::vector<ZoneNeed> needs;
  for (const CatalogZone& zone : catalog.zones) needs.push_back({zone.slots, zone.signatures});
  return needs;
}

std::vector<float> load_times_of(const std::vector<LoadWork>& work, const LoadRates& rates,
                                 std::int64_t period_ns) {
  std::vector<float> times;
  for (const LoadWork& zone : work) {
    const std::int64_t ns = load_time_ns(zone, rates) + 2 * period_ns;
    times.push_back(static_cast<float>(static_cast<double>(ns) / 1e9));
  }
  return times;
}

ResidencyLimits limits_for(const Catalog& catalog, std::optional<ByteCount> budget,
                           std::uint64_t max_signatures, const std::vector<ZoneId>& pinned) {
  const MapCosts costs = catalog.costs();
  const SmallestBudget smallest = smallest_budget(costs, pinned);
  std::uint64_t all_slots = 0;
  for (const std::uint32_t slots : costs.zone_slots) all_slots += slots;
  ResidencyLimits limits;
  limits.budget = budget.value_or(max_signatures > 0 ? charged_with(catalog.fixed_bytes, all_slots)
                                                     : smallest.bytes);
  limits.fixed = catalog.fixed_bytes;
  limits.slot_bytes = kSlotBytes + kTableBytesPerSlot;
  limits.max_signatures = max_signatures;
  // They may be different pairs.
  limits.largest_pair = {smallest.pair.amount,
                         largest_pair(signatures_of(catalog), costs.neighbours, pinned).amount};
  return limits;
}

std::string smallest_budget_text(const Catalog& catalog, const std::vector<ZoneId>& pinned) {
  return "the smallest budget for this map" + std::string(pinned.empty() ? "" : " and its pins") +
         " is " + format_byte_count(catalog.smallest(pinned).bytes) +
         "; what sets it: zonepack plan " + shell_word(catalog.folder);
}

Outcome<void> check_limits(const Catalog& catalog, const ResidencyLimits& limits,
                           const std::vector<ZoneId>& pinned) {
  if (limits.fixed > limits.budget) {
    return failure("budget " + format_byte_count(limits.budget) +
                       ": tables and read buffers alone take " + std::to_string(limits.fixed) +
                       " bytes; " + smallest_budget_text(catalog, pinned),
                   ErrorCode::kNoRoom);
  }
  if (catalog.zones.empty()) return {};
  const std::uint64_t slots =
      Residency::slots_within(limits.budget, limits.fixed, limits.slot_bytes);
  const auto place = std::min<std::uint64_t>(slots, limits.most_slots);
  const CatalogZone& widest = *std::ranges::max_element(catalog.zones, {}, &CatalogZone::slots);
  if (widest.slots > slots) {
    return failure(
        "zone " + widest.name + " takes " + std::to_string(widest.slots * limits.slot_bytes) +
            " bytes besides " + std::to_string(limits.fixed) +
            " for tables and buffers, over the budget of " + format_byte_count(limits.budget) +
            "; " + smallest_budget_text(catalog, pinned),
        ErrorCode::kNoRoom);
  }
  if (widest.slots > place) {
    return failure("zone " + widest.name + " takes " + std::to_string(widest.slots) + " slots of " +
                       std::to_string(kSlotBytes) + " bytes, over the " + std::to_string(place) +
                       " that were reserved when zoned started; start it again with this map",
                   ErrorCode::kNoRoom);
  }
  const CatalogZone& fullest =
      *std::ranges::max_element(catalog.zones, {}, &CatalogZone::signatures);
  if (limits.max_signatures > 0 && fullest.signatures > limits.max_signatures) {
    return failure("zone " + fullest.name + " has " + std::to_string(fullest.signatures) +
                       " signatures, over the limit of " + std::to_string(limits.max_signatures) +
                       "; the smallest limit for this map is " +
                       std::to_string(limits.largest_pair.signatures) + " signatures",
                   ErrorCode::kNoRoom);
  }
  return {};
}

std::optional<std::string> tightness_warning(const Catalog& catalog, const ResidencyLimits& limits,
                                             const std::vector<ZoneId>& pinned) {
  const auto slots = std::min<std::uint64_t>(
      Residency::slots_within(limits.budget, limits.fixed, limits.slot_bytes), limits.most_slots);
  for (const CatalogPortal& portal : catalog.portals) {
    const CatalogZone &a = catalog.zones[portal.zone_a], &b = catalog.zones[portal.zone_b];
    const NeedSum pair = pair_of(a, b);
    const std::string both = "zones " + a.name + " and " + b.name + " do not fit together";
    if (pair.slots > slots) {
      return both + " in " + format_byte_count(limits.budget) +
             ": the robot will enter one before it is loaded; " +
             smallest_budget_text(catalog, pinned);
    }
    if (limits.max_signatures > 0 && pair.signatures > limits.max_signatures) {
      return both + " in " + std::to_string(limits.max_signatures) +
             " signatures: the robot will enter one before it is loaded; the smallest limit for "
             "this map is " +
             std::to_string(limits.largest_pair.signatures) + " signatures";
    }
  }
  return std::nullopt;
}

}  // namespace zonepack
