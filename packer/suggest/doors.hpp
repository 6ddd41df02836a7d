// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/suggest/regions.hpp"

namespace zonepack::packer::suggest {

// Moves every border between two regions onto the shortest straight line across the pass: from wall
// to wall, each end at most `reach_m` along the wall from where it was. A border that has no such
// line (it bends around a pillar, say) stays.
void straighten_doors(Regions& regions, const FreeSpace& space, double reach_m);

}  // namespace zonepack::packer::suggest
