// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/zones/drawn.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/zone_plan.hpp"

// Portals: those that were drawn are moved onto the border of their zones; where none were drawn
// they are found. The rules stand in zone_file.hpp.
namespace zonepack::packer {

// Appends the drawn portals to the plan, whose zones are final. `known` tells zones that exist but
// could not be used: portals to them are left out without a fault of their own.
void place_portals(const Drawing& drawing, double snap_m, ZonePlan& plan, Findings& findings);

// Appends a portal at every border of at least kMinFoundPortal_m that two zones share.
void find_portals(double snap_m, ZonePlan& plan);

}  // namespace zonepack::packer
