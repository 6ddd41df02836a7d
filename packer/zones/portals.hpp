// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/zones/drawn.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/zone_plan.hpp"

// Portals: drawn ones are moved onto the border of their zones; without drawn ones, portals are
// found at shared borders. zone_file.hpp gives the rules.
namespace zonepack::packer {

// Appends the drawn portals to the plan, whose zones are final. Portals to a drawn zone that could
// not be used are skipped without a fault of their own.
void place_portals(const Drawing& drawing, double snap_m, ZonePlan& plan, Findings& findings);

// Appends a portal at every border of at least kMinFoundPortal_m that two zones share.
void find_portals(double snap_m, ZonePlan& plan, Findings& findings);

}  // namespace zonepack::packer
