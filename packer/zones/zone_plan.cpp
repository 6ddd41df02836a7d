// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_plan.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace zonepack::packer {

bool share_a_height(const PlannedZone& a, const PlannedZone& b) noexcept {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  return a.z_min_m.value_or(-kInf) < b.z_max_m.value_or(kInf) &&
         b.z_min_m.value_or(-kInf) < a.z_max_m.value_or(kInf);
}

void sort_by_name(ZonePlan& plan) {
  std::vector<std::uint32_t> order(plan.zones.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return plan.zones[a].name < plan.zones[b].name;
  });
  std::vector<PlannedZone> zones;
  std::vector<std::uint32_t> place(order.size());
  zones.reserve(order.size());
  for (const std::uint32_t old : order) {
    place[old] = static_cast<std::uint32_t>(zones.size());
    zones.push_back(std::move(plan.zones[old]));
  }
  plan.zones = std::move(zones);
  for (PlannedPortal& portal : plan.portals) {
    portal.zone_a = place[portal.zone_a];
    portal.zone_b = place[portal.zone_b];
  }
  std::sort(plan.portals.begin(), plan.portals.end(),
            [](const PlannedPortal& a, const PlannedPortal& b) { return a.name < b.name; });
}

std::string portal_name(const std::string& zone_a, const std::string& zone_b, std::size_t number) {
  std::string name = zone_a + "-" + zone_b;
  if (number > 1) name += "." + std::to_string(number);
  return name;
}

}  // namespace zonepack::packer
