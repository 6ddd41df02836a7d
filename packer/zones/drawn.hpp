// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "packer/zones/findings.hpp"
#include "packer/zones/geojson.hpp"
#include "packer/zones/zone_plan.hpp"

// Inside of the zone file reader: features as drawn, before zones and portals are held against each
// other.
namespace zonepack::packer {

struct DrawnZone {
  std::size_t feature = 0, line = 0;
  PlannedZone zone;
  bool sound = false;  // its outline can be used
};

struct DrawnPortal {
  std::size_t feature = 0, line = 0;
  std::string name;  // empty: to be given
  std::array<std::string, 2> zones;
  Segment2 segment;
};

struct Drawing {
  std::vector<DrawnZone> zones;
  std::vector<DrawnPortal> portals;
  std::size_t portal_features = 0;  // also those that are faulty
};

// Reads each feature for itself; what is wrong with it becomes a fault.
Drawing read_drawing(const std::vector<GeoJsonFeature>& features, Findings& findings);

}  // namespace zonepack::packer
