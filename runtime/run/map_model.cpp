// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/map_model.hpp"

#include <algorithm>

#include "runtime/run/map_demand.hpp"

namespace zonepack {
namespace {

bool find_pins(const Catalog& catalog, const std::vector<std::string>& names,
               std::vector<ZoneId>& pinned, std::string& fault) {
  for (const std::string& name : names) {
    const ZoneId zone = catalog.find(name);
    if (zone == kNoZone) {
      fault = "memory.pinned: the map " + catalog.folder + " has no zone " + name;
      return false;
    }
    if (std::find(pinned.begin(), pinned.end(), zone) == pinned.end()) pinned.push_back(zone);
  }
  return true;
}

std::uint32_t slots_to_reserve(const std::vector<ZoneNeed>& needs, const ResidencyLimits& limits) {
  std::uint64_t all = 0, largest = 0;
  for (const ZoneNeed& need : needs) {
    all += need.slots;
    largest = std::max<std::uint64_t>(largest, need.slots);
  }
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(
      all + largest, Residency::slots_within(limits.budget, limits.fixed, limits.slot_bytes)));
}

}  // namespace

std::unique_ptr<MapModel> MapModel::make(const Catalog& catalog, const MapTerms& terms,
                                         std::string& fault) {
  std::vector<ZoneId> pinned;
  if (!find_pins(catalog, terms.pinned, pinned, fault)) return nullptr;
  ResidencyLimits limits = limits_for(catalog, terms.budget, terms.max_signatures, pinned);
  limits.lease_ns = terms.lease_ns;
  if (terms.slots) limits.most_slots = *terms.slots;
  if (const auto refused = refusal(catalog, limits, pinned)) {
    fault = *refused;
    return nullptr;
  }
  std::vector<ZoneNeed> needs = needs_of(catalog);
  std::vector<LoadWork> work = work_of(catalog);
  std::vector<float> load_s = load_times_of(work, terms.rates, terms.period_ns);
  const std::uint32_t slots = terms.slots.value_or(slots_to_reserve(needs, limits));
  std::optional<std::string> warning = tightness(catalog, limits, pinned);
  return std::unique_ptr<MapModel>(
      new MapModel{catalog, std::move(pinned), limits, graph_of(catalog), std::move(needs),
                   std::move(work), std::move(load_s), slots, std::move(warning)});
}

MapTerms MapModel::terms_of_next(const MapTerms& terms) const {
  MapTerms next = terms;
  next.budget = limits.budget;
  next.slots = slots;
  return next;
}

bool MapModel::pin(Residency& memory, std::string& fault) const {
  for (const ZoneId zone : pinned) {
    if (memory.pin(zone, needs[zone])) continue;
    fault = "memory.pinned: zone " + graph.name(zone) +
            " does not fit beside the largest pair of neighbours in a budget of " +
            format_byte_count(limits.budget) +
            "; pin less, or allow more: " + smallest_budget_text(catalog, pinned);
    return false;
  }
  return true;
}

}  // namespace zonepack
