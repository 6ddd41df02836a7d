// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/suggest/regions.hpp"

namespace zonepack::packer::suggest {

// Gives free cells that belong to no region, such as a corner behind a desk, to the nearest region,
// together with a bridge of one cell across what is between: up to `reach_m`, or kSpeckReach_m for
// specks under kSpeck_m2. What is farther away stays alone.
inline constexpr double kSpeck_m2 = 0.1, kSpeckReach_m = 0.15;
void fold_islets(Regions& regions, const FreeSpace& space, double reach_m);

}  // namespace zonepack::packer::suggest
