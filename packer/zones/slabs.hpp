// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"

// Where to cut a row of weights.
namespace zonepack::packer {

struct Weight {
  double place_m = 0;  // along the length
  ByteCount bytes = 0;
};

struct Gap {
  double from_m = 0, to_m = 0;
};

// Signatures nearer to each other than this stand at one place: a robot's position is hardly known
// better, and a part as narrow as this would hardly ever be entered.
inline constexpr double kOnePlace_m = 0.01;

// The gaps in which to cut so that no slab weighs more than `limit`, in ascending order: as few
// cuts as possible, slabs nearly even (within 15 % of a slab's mean), through the widest gaps. What
// lies within `one_place_m` (and always within 1 um) is not cut apart; when it exceeds the limit
// together it makes a slab of its own. `weights` sorted by place. O(n) and the gaps looked at,
// O(n^2) at worst.
std::vector<Gap> choose_cuts(std::span<const Weight> weights, ByteCount limit, double one_place_m);

}  // namespace zonepack::packer
