// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// The zones of a building and the portals between them, as the user drew them. Metres, map frame.
namespace zonepack::packer {

struct PlannedZone {
  std::string name;    // unique; see find_name_problem()
  std::string parent;  // the zone that this is a part of after a split; else empty
  std::string zone_type, label, layer, floor;  // empty when the file has none
  // Only signatures with z_min_m <= z < z_max_m belong to the zone; nullopt: no bound.
  std::optional<double> z_min_m, z_max_m;
  Polygon polygon;  // interior on the left of every edge: outer counter-clockwise, holes clockwise
};

struct PlannedPortal {
  std::string name;                      // unique
  std::uint32_t zone_a = 0, zone_b = 0;  // indices into ZonePlan::zones; different
  Segment2 segment;                      // on the shared border
  friend bool operator==(const PlannedPortal& a, const PlannedPortal& b) {
    return a.name == b.name && a.zone_a == b.zone_a && a.zone_b == b.zone_b &&
           a.segment.p == b.segment.p && a.segment.q == b.segment.q;
  }
};

struct ZonePlan {
  std::vector<PlannedZone> zones;      // sorted by name, byte order
  std::vector<PlannedPortal> portals;  // sorted by name, byte order
  bool portals_found = false;          // the file had none, so they were found at shared borders
};

// Whether two zones can both hold a point of one height.
bool share_a_height(const PlannedZone& a, const PlannedZone& b) noexcept;

// Sorts zones and portals by name and updates the portals' indices. Returns the new index of each
// zone by its old one.
std::vector<std::uint32_t> sort_by_name(ZonePlan& plan);

// How many portals lead into each zone.
std::vector<std::size_t> portals_per_zone(const ZonePlan& plan);

// A name for an unnamed portal: "A-B", or "A-B.2" and so on when that is taken; long zone names are
// shortened. Adds the name to `taken`.
std::string fresh_portal_name(const std::string& zone_a, const std::string& zone_b,
                              std::set<std::string>& taken);

}  // namespace zonepack::packer
