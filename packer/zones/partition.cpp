// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/partition.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "packer/zones/findings.hpp"
#include "packer/zones/plane.hpp"
#include "platform/base/require.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kOrphansNamed = 20;

bool holds_height(const PlannedZone& zone, double z_m) noexcept {
  return (!zone.z_min_m || *zone.z_min_m <= z_m) && (!zone.z_max_m || z_m < *zone.z_max_m);
}

struct Holder {
  std::uint32_t zone = Partition::kNone;
  Side side = Side::kOutside;
};

Holder holder_of(std::span<const PlannedZone> zones, std::span<const Box2> boxes,
                 const SignaturePlace& place) {
  Holder holder;
  const Box2 here{place.p_map, place.p_map};
  for (std::uint32_t i = 0; i < zones.size() && holder.side != Side::kInside; ++i) {
    if (!boxes_meet(boxes[i], here, kBorderTolerance_m)) continue;
    if (!holds_height(zones[i], place.z_map_m)) continue;
    const Side side = side_of(zones[i].polygon, place.p_map);
    if (side > holder.side) holder = {i, side};
  }
  return holder;
}

Orphan nearest_to(std::span<const PlannedZone> zones, const SignaturePlace& place) {
  Orphan orphan{place.id, place.p_map, Partition::kNone, 0};
  bool right_height = false;
  for (std::uint32_t i = 0; i < zones.size(); ++i) {
    const bool fits = holds_height(zones[i], place.z_map_m);
    const double distance = distance_to_border_m(zones[i].polygon, place.p_map);
    const bool better = orphan.nearest_zone == Partition::kNone || (fits && !right_height) ||
                        (fits == right_height && distance < orphan.distance_m);
    if (!better) continue;
    orphan.nearest_zone = i;
    orphan.distance_m = distance;
    right_height = fits;
  }
  return orphan;
}

[[noreturn]] void refuse(const std::vector<Orphan>& orphans, std::span<const PlannedZone> zones) {
  std::string text = std::to_string(orphans.size()) +
                     (orphans.size() == 1 ? " signature stands" : " signatures stand") +
                     " in no zone:";
  for (std::size_t i = 0; i < orphans.size() && i < kOrphansNamed; ++i) {
    const Orphan& orphan = orphans[i];
    text += "\n  signature " + std::to_string(orphan.id) + " at " + point_text(orphan.p_map) +
            ", " + number_text(orphan.distance_m) + " m from zone '" +
            zones[orphan.nearest_zone].name + "'";
  }
  if (orphans.size() > kOrphansNamed) {
    text += "\n  and " + std::to_string(orphans.size() - kOrphansNamed) + " more";
  }
  throw std::runtime_error(
      text + "\nextend the zones to hold them, or choose --orphans nearest or --orphans drop");
}

}  // namespace

Partition partition(std::span<const PlannedZone> zones, std::span<const SignaturePlace> signatures,
                    OrphanPolicy policy) {
  ZP_REQUIRE(!zones.empty());
  std::vector<Box2> boxes;
  for (const PlannedZone& zone : zones) boxes.push_back(bounds(zone.polygon.outer));

  Partition result;
  result.signatures.resize(zones.size());
  for (const SignaturePlace& place : signatures) {
    if (!std::isfinite(place.p_map.x_m) || !std::isfinite(place.p_map.y_m) ||
        !std::isfinite(place.z_map_m)) {
      throw std::runtime_error("signature " + std::to_string(place.id) +
                               " has a position that is not a number; repair the map's poses");
    }
    Holder holder = holder_of(zones, boxes, place);
    if (holder.side == Side::kBorder) ++result.on_border;
    if (holder.side == Side::kOutside) {
      result.orphans.push_back(nearest_to(zones, place));
      if (policy == OrphanPolicy::kNearest) holder.zone = result.orphans.back().nearest_zone;
    }
    result.zone_of.push_back(holder.zone);
    if (holder.zone != Partition::kNone) ++result.signatures[holder.zone];
  }
  if (policy == OrphanPolicy::kError && !result.orphans.empty()) refuse(result.orphans, zones);
  return result;
}

ZoneLookup::ZoneLookup(std::span<const PlannedZone> zones) : zones_(zones) {
  for (const PlannedZone& zone : zones) boxes_.push_back(bounds(zone.polygon.outer));
}

std::uint32_t ZoneLookup::at(Point2 p_map, double z_map_m) const {
  return holder_of(zones_, boxes_, {0, p_map, z_map_m}).zone;
}

std::size_t count_outside(std::span<const PlannedZone> zones,
                          std::span<const SignaturePlace> signatures) {
  std::vector<Box2> boxes;
  for (const PlannedZone& zone : zones) boxes.push_back(bounds(zone.polygon.outer));
  std::size_t outside = 0;
  for (const SignaturePlace& place : signatures) {
    if (holder_of(zones, boxes, place).side == Side::kOutside) ++outside;
  }
  return outside;
}

}  // namespace zonepack::packer
