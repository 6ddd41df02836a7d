// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/maps/map_model.hpp"

#include <algorithm>

#include "runtime/control/expected_use.hpp"
#include "runtime/pack_format/file/transitions_bytes.hpp"
#include "runtime/run/maps/map_demand.hpp"

namespace zonepack {
namespace {

Outcome<std::vector<ZoneId>> find_pins(const Catalog& catalog,
                                       const std::vector<std::string>& names) {
  std::vector<ZoneId> pinned;
  for (const std::string& name : names) {
    const ZoneId zone = catalog.find(name);
    if (zone == kNoZone) {
      return failure("memory.pinned: the map " + catalog.folder + " has no zone " + name,
                     ErrorCode::kNotFound);
    }
    if (!catalog.zones[zone].loadable) {
      return failure("memory.pinned: zone " + name + " is of layer " +
                         catalog.layers[catalog.zones[zone].layer] +
                         ", which memory.layers leaves out; add it there, or pin less",
                     ErrorCode::kNotFound);
    }
    if (std::find(pinned.begin(), pinned.end(), zone) == pinned.end()) pinned.push_back(zone);
  }
  return pinned;
}

// What is charged for reading a manifest, of what that takes.
ByteCount charged_reading(const Catalog& catalog) {
  return catalog.reading_bytes - std::min(catalog.reading_bytes, kFreeMapBytes);
}

// What a budget must hold besides this map, so that another version with the same tables can come.
ByteCount tables_of_next(const Catalog& catalog) {
  const ByteCount need = catalog.bytes_to_open() - charged_reading(catalog);
  return need - std::min(need, kFreeMapBytes);
}

std::uint32_t slots_to_reserve(const Catalog& catalog, const std::vector<ZoneNeed>& needs,
                               const ResidencyLimits& limits) {
  std::uint64_t all = 0, largest = 0;
  for (const ZoneNeed& need : needs) {
    all += need.slots;
    largest = std::max<std::uint64_t>(largest, need.slots);
  }
  const auto within = [&](ByteCount fixed) {
    return std::uint64_t{Residency::slots_within(limits.budget, fixed, limits.slot_bytes)};
  };
  std::uint64_t slots = std::min(all + largest, within(limits.fixed));
  if (const ByteCount tables = tables_of_next(catalog); tables > 0) {
    const std::uint64_t beside = within(limits.fixed + tables);
    slots = std::min(slots, std::max<std::uint64_t>(beside, limits.largest_pair.slots));
  }
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(slots, kNoSlot - 1));
}

Outcome<void> check_default(const Catalog& catalog, const MapTerms& terms,
                            const ResidencyLimits& limits) {
  if (terms.budget || limits.budget <= terms.default_most || catalog.zones.empty()) return {};
  const CatalogZone& widest = *std::ranges::max_element(catalog.zones, {}, &CatalogZone::slots);
  return failure("memory.budget is not set, and the map asks for " +
                     format_byte_count(limits.budget) + " (zone " + widest.name + " for " +
                     format_byte_count(widest.slots * limits.slot_bytes) +
                     "), over the default limit of " + format_byte_count(terms.default_most) +
                     ", a quarter of this computer's memory; set memory.budget (--budget), or pack "
                     "smaller zones (zonepack build --max-zone-bytes)",
                 ErrorCode::kNoRoom);
}

}  // namespace

Outcome<std::unique_ptr<MapModel>> MapModel::make(const Catalog& catalog, const MapTerms& terms) {
  if (terms.learned && terms.learned->map_lineage != catalog.lineage) {
    return failure("preload.transitions: was learned on another map (lineage " +
                       to_hex(terms.learned->map_lineage) + "; that of " + catalog.folder + " is " +
                       to_hex(catalog.lineage) + "); learn it on this one (zoned learn)",
                   ErrorCode::kMismatch);
  }
  auto pinned = find_pins(catalog, terms.pinned);
  if (!pinned) return pinned.error();
  ResidencyLimits limits = limits_for(catalog, terms.budget, terms.max_signatures, *pinned);
  limits.lease_ns = terms.lease_ns;
  if (const auto possible = check_default(catalog, terms, limits); !possible)
    return possible.error();
  if (terms.slots) limits.most_slots = *terms.slots;
  if (const auto possible = check_limits(catalog, limits, *pinned); !possible) {
    return possible.error();
  }
  std::vector<ZoneNeed> needs = needs_of(catalog);
  const std::uint32_t slots = terms.slots.value_or(slots_to_reserve(catalog, needs, limits));
  if (!terms.slots && tables_of_next(catalog) > 0) limits.most_slots = slots;
  std::optional<std::string> warning = tightness_warning(catalog, limits, *pinned);
  return std::unique_ptr<MapModel>(
      new MapModel{.catalog = catalog,
                   .pinned = std::move(*pinned),
                   .limits = limits,
                   .graph = graph_of(catalog),
                   .needs = std::move(needs),
                   .load_s = load_times_of(work_of(catalog), terms.rates, terms.period_ns),
                   .slots = slots,
                   .warning = std::move(warning)});
}

ByteCount MapModel::room_for_next() const noexcept {
  const ByteCount held = limits.fixed + slots * limits.slot_bytes;
  return limits.budget - std::min(limits.budget, held) + charged_reading(catalog) + kFreeMapBytes;
}

ByteCount extra_fixed_bytes(const Catalog& catalog, const MapTerms& terms) {
  const std::size_t zones = catalog.zones.size();
  ByteCount bytes = 0;
  if (terms.habits) bytes += transitions_bytes(catalog.costs());
  if (terms.eviction == EvictionRule::kExpected) {
    bytes += ExpectedUse::table_bytes(zones) + Residency::order_bytes(zones);
  }
  return bytes;
}

Catalog charged_on(Catalog catalog, const MapTerms& terms) {
  catalog.fixed_bytes += extra_fixed_bytes(catalog, terms);
  return catalog;
}

MapTerms MapModel::terms_of_next(const MapTerms& terms) const {
  MapTerms next = terms;
  next.learned = nullptr;  // the cycle takes over what the one before it knows
  next.budget = limits.budget;
  next.slots = slots;
  return next;
}

Outcome<void> MapModel::pin(Residency& memory) const {
  for (const ZoneId zone : pinned) {
    if (memory.pin(zone, needs[zone])) continue;
    return failure("memory.pinned: zone " + graph.name(zone) +
                       " does not fit beside the largest pair of neighbours in a budget of " +
                       format_byte_count(limits.budget) +
                       "; pin less, or allow more: " + smallest_budget_text(catalog, pinned),
                   ErrorCode::kNoRoom);
  }
  return {};
}

}  // namespace zonepack
