// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/memory/eviction_order.hpp"

namespace zonepack {

// The candidate with the lowest value_of(zone); of several, the one used least recently. One look
// at each candidate.
template <typename ValueOf>
ZoneId least_of(const EvictionCandidates& candidates, ValueOf&& value_of) noexcept {
  ZoneId best = candidates.coldest();
  auto least = value_of(best);
  for (ZoneId zone = candidates.warmer(best); zone != kNoZone; zone = candidates.warmer(zone)) {
    const auto value = value_of(zone);
    if (!(value < least)) continue;
    least = value;
    best = zone;
  }
  return best;
}

}  // namespace zonepack
