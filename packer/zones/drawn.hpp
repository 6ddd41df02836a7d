// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "packer/zones/findings.hpp"
#include "packer/zones/geojson.hpp"
#include "packer/zones/zone_plan.hpp"

// Part of the zone file reader: features as drawn, before zones and portals are checked against
// each other.
namespace zonepack::packer {

struct DrawnZone {
  std::size_t feature = 0, line = 0;
  PlannedZone zone;
  bool sound = false;  // its outline is usable
};

struct DrawnPortal {
  std::size_t feature = 0, line = 0;
  std::string name;  // empty: not named yet
  std::array<std::string, 2> zones;
  Segment2 segment;
};

struct Drawing {
  std::vector<DrawnZone> zones;
  std::vector<DrawnPortal> portals;
  std::size_t portal_features = 0;  // including faulty ones
};

// Reads each feature on its own; every error becomes a fault.
Drawing read_drawing(const std::vector<GeoJsonFeature>& features, Findings& findings);

}  // namespace zonepack::packer
