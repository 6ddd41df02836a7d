// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "packer/suggest/borders.hpp"

// Where regions touch on free ground.
namespace zonepack::packer::suggest {

// A stretch of a border between two regions with free cells on both sides: its corners from `from`
// to `to`.
struct Opening {
  std::size_t from = 0, to = 0;
};

std::vector<Opening> openings_of(const Border& border, const FreeSpace& space);

// How wide it is, in cells, squared; nothing where it runs all around a region.
std::optional<std::int64_t> width2_of(const Opening& opening, const Border& border);

// Takes regions apart that touch only where no robot fits through, along less than `least_m`: the
// cells along one side of such a crack belong to none afterwards. Cracks that alone join a region
// to others, by whatever way, stay. Returns whether anything changed; regions may have fallen
// apart.
bool part_at_cracks(Regions& regions, const FreeSpace& space, double least_m);

}  // namespace zonepack::packer::suggest
