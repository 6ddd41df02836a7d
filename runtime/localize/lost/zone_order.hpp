// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack::localize {

// What a search needs to know of a zone before it is loaded.
struct SearchZone {
  std::uint32_t signatures = 0;
  Point2 middle;
  std::vector<ZoneId> doors;  // zones that a portal leads to; where unknown, none
};
Point2 middle_of(const Ring& outline) noexcept;
std::vector<SearchZone> search_zones(const Catalog& map);

// The order in which a lost robot's zones are tried: the last known one, then door by door from
// there, nearer ones first; without a last one from the zone with most signatures, where a robot is
// most often. Zones that no door leads to come last. Each zone once.
std::vector<ZoneId> search_order(std::span<const SearchZone> zones, ZoneId last);

}  // namespace zonepack::localize
