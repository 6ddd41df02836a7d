// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "packer/suggest/regions.hpp"

namespace zonepack::packer::suggest {

// Rooms as basins of clearance (0-dimensional persistence): cells are flooded by falling clearance.
// Two basins that meet where the clearance is at least `door_ratio` times the peak of the narrower
// one become one room; elsewhere the place where they meet is a door. Ties go by cell index.
Regions basins_of(const FreeSpace& space, const std::vector<std::int32_t>& clearance2,
                  double door_ratio);

}  // namespace zonepack::packer::suggest
