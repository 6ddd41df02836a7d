// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "platform/base/byte_count.hpp"

namespace zonepack {

inline constexpr std::uint64_t kMostTransitionContexts = 2048;
inline constexpr ByteCount kTransitionContextBytes = 144;

// What a robot's table of which zone comes next (runtime/zones/transitions.hpp) takes from the
// budget besides the map's fixed bytes: a context for each zone, and one for each way through a
// portal.
constexpr ByteCount transitions_bytes(std::uint64_t zones, std::uint64_t portals) noexcept {
  return std::min(kMostTransitionContexts, zones + 2 * portals) * kTransitionContextBytes;
}

}  // namespace zonepack
