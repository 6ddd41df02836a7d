// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "packer/suggest/regions.hpp"

namespace zonepack::packer::suggest {

// Cuts corridors off halls that they open into without a door: parts at most half as wide as the
// region at its widest, and at least four times as long as wide. What remains must be a room of
// 15 m2 or more by itself.
void cut_arms(Regions& regions, const FreeSpace& space,
              const std::vector<std::int32_t>& clearance2);

}  // namespace zonepack::packer::suggest
