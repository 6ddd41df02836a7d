// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "packer/zones/zone_plan.hpp"

namespace zonepack::packer {

// A zone file as parse_zone_file() reads it, one feature a line. Zones come first, then portals;
// each also says how large it is (area_m2, width_m), for people. Coordinates in metres of the map
// frame, rounded to a tenth of a millimetre.
std::string zones_geojson(const ZonePlan& plan);

}  // namespace zonepack::packer
