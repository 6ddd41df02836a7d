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

// Signatures nearer to each other than this count as one place: a robot's position is hardly known
// better, and a part this narrow would hardly ever be entered.
inline constexpr double kOnePlace_m = 0.01;

// The gaps to cut in, ascending, so that no slab weighs more than `limit`: as few cuts as possible,
// slabs nearly even (within 15 % of a slab's mean), through the widest gaps. Weights within
// `one_place_m` (and always within 1 um) stay together; when they exceed the limit together, they
// form a slab of their own. `weights` must be sorted by place. O(n) plus the gaps examined, O(n^2)
// at worst.
std::vector<Gap> choose_cuts(std::span<const Weight> weights, ByteCount limit, double one_place_m);

}  // namespace zonepack::packer
