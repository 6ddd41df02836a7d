// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/suggest/regions.hpp"

namespace zonepack::packer::suggest {

// What a person would call a room, from its shape alone.
//
//   corridor  four times as long as it is wide at its widest, with two neighbours or more; or three
//             times, with five; up to 5 m wide
//   lobby     30 m2 or more, with three neighbours or more
//   hall      100 m2 or more
//   closet    under 4 m2
//   room      everything else
struct Kind {
  const char* name = "room";
  double area_m2 = 0;
};

std::vector<Kind> kinds_of(const Regions& regions, const FreeSpace& space,
                           const std::vector<std::int32_t>& clearance2);

// "corridor-1", "room-12": numbered by falling area within a kind.
std::vector<std::string> names_of(const std::vector<Kind>& kinds);

}  // namespace zonepack::packer::suggest
