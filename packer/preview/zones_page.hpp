// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "packer/outline/map_drawing.hpp"
#include "packer/zones/orphans.hpp"
#include "packer/zones/partition.hpp"
#include "packer/zones/zone_file.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::packer {

// A zone file and, with a database, what it holds of the zones' building.
struct ZonesOnMap {
  std::string file;  // as the user named it
  const ZoneFile* zones = nullptr;
  std::vector<SignaturePlace> places;  // of the signatures with an optimised pose
  Partition partition;                 // of these; empty without zones
  std::optional<Misdrawn> misdrawn;
  const MapDrawing* ground = nullptr;  // null without a database
  // Tables break long texts into several rows: for a sheet, which does not wrap cells.
  bool wrap = false;
  std::string origin;  // who drew it from what; empty: check-zones, from the file
};

// One page: the zones over the occupancy grid, faults and orphans in red, and both as tables.
report::Report make_zones_page(const ZonesOnMap& map);

}  // namespace zonepack::packer
