// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "packer/zones/zone_plan.hpp"

// Zones of a map that exists, with some of a zone file in their place or besides them.
namespace zonepack::packer {

struct Redrawn {
  ZonePlan plan;
  std::set<std::string> fresh;         // zones of the file that are in the plan
  std::vector<std::string> not_taken;  // of the file, that neither the map nor `replaced` has
  std::vector<std::string> warnings;   // complete sentences
};

// Replaces zones of the map, or all parts of one that was split, by the file's zones of that name,
// with the file's portals to them; other zones of the file are left alone. Throws
// std::runtime_error with every fault of the drawing, and when the file lacks a zone of `replaced`.
Redrawn redraw(const ZonePlan& held, const std::string& path, double snap_m,
               const std::set<std::string>& replaced);

// Adds the file's zones that the map does not have, with the file's portals to them. Throws
// std::runtime_error with every fault of the drawing, zones that overlap those of the map among
// them, and when the file draws a zone of the map otherwise than the map has it.
Redrawn add_zones(const ZonePlan& held, const std::string& path, double snap_m);

}  // namespace zonepack::packer
