// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_plan.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "platform/base/utf8.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kNameInPair = 28;  // two of them, "-" and ".123456" are 64 bytes

// At most kNameInPair bytes, without cutting a UTF-8 character in two.
std::string shortened(const std::string& name) {
  if (name.size() <= kNameInPair) return name;
  std::size_t end = kNameInPair;
  while (end > 0 && continues_utf8(name[end])) --end;
  return name.substr(0, end);
}

}  // namespace

bool share_a_height(const PlannedZone& a, const PlannedZone& b) noexcept {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  return a.z_min_m.value_or(-kInf) < b.z_max_m.value_or(kInf) &&
         b.z_min_m.value_or(-kInf) < a.z_max_m.value_or(kInf);
}

std::vector<std::uint32_t> sort_by_name(ZonePlan& plan) {
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
  return place;
}

std::vector<std::size_t> portals_per_zone(const ZonePlan& plan) {
  std::vector<std::size_t> portals(plan.zones.size());
  for (const PlannedPortal& portal : plan.portals) {
    ++portals[portal.zone_a];
    ++portals[portal.zone_b];
  }
  return portals;
}

std::string fresh_portal_name(const std::string& zone_a, const std::string& zone_b,
                              std::set<std::string>& taken) {
  const std::string pair = shortened(zone_a) + "-" + shortened(zone_b);
  std::string name = pair;
  for (std::size_t number = 2; !taken.insert(name).second; ++number) {
    name = pair + "." + std::to_string(number);
  }
  return name;
}

}  // namespace zonepack::packer
