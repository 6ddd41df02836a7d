// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run_result.hpp"

namespace zonepack {

void describe_map(const MapModel& map, RunTrace& trace) {
  const ResidencyLimits& limits = map.limits;
  for (const CatalogZone& zone : map.catalog.zones) {
    trace.zones.push_back(
        {zone.name, zone.zone_type, zone.polygon, zone.signatures, zone.slots * limits.slot_bytes});
  }
  for (const CatalogPortal& portal : map.catalog.portals) {
    trace.portals.push_back({portal.segment, portal.zone_a, portal.zone_b});
  }
  trace.budget_bytes = limits.budget;
  trace.fixed_bytes = limits.fixed;
  trace.max_signatures = limits.max_signatures;
  trace.duration_s = trace.samples.empty() ? 0 : trace.samples.back().t_s;
}

void summarise_cycle(const Cycle& cycle, RunSummary& summary) {
  summary.zone_switches = cycle.state().zone_switches;
  summary.can_rejected = cycle.odometry_counters().rejected;
  summary.corrections_used = cycle.filter_counters().used;
  summary.corrections_rejected = cycle.filter_counters().rejected;
}

}  // namespace zonepack
