// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "packer/suggest/regions.hpp"

namespace zonepack::packer::suggest {

// Joins neighbours that furniture separates rather than a door. A door stands in a wall: next to at
// least one of its ends, the outlines of both rooms run along two sides of something thin. Where
// that is not so (between a bed and a wall, say), the pass is a door only when it is narrower than
// `loose_ratio` of the narrower region. Wide passes are judged first; ties go by region.
void join_without_door(Regions& regions, const FreeSpace& space,
                       const std::vector<std::int32_t>& clearance2, double loose_ratio);

}  // namespace zonepack::packer::suggest
