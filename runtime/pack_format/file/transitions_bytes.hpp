// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/accounting.hpp"

// What a robot's table of which zone comes next (runtime/zones/transitions.hpp) takes from the
// budget besides the map's fixed bytes.
namespace zonepack {

inline constexpr std::uint64_t kMostTransitionContexts = 2048;
inline constexpr std::uint64_t kMostTransitionSuccessors = 8;  // of a context
inline constexpr ByteCount kTransitionContextBytes = 9;
inline constexpr ByteCount kTransitionSuccessorBytes = 8;

// Room for all that can be learned of a map: for each zone a context wherever the robot came from,
// and one for each portal that it came by; in each, a successor for each portal.
class TransitionRoom {
 public:
  // A zone with so many portals.
  constexpr void add(std::uint64_t portals) noexcept {
    contexts_ += 1 + portals;
    successors_ += (1 + portals) * std::min(kMostTransitionSuccessors, portals);
  }
  constexpr std::uint64_t contexts() const noexcept {
    return std::min(kMostTransitionContexts, contexts_);
  }
  constexpr std::uint64_t successors() const noexcept {
    return std::min(kMostTransitionContexts * kMostTransitionSuccessors, successors_);
  }
  constexpr ByteCount bytes() const noexcept {
    return contexts() * kTransitionContextBytes + successors() * kTransitionSuccessorBytes;
  }

 private:
  std::uint64_t contexts_ = 0;
  std::uint64_t successors_ = 0;
};

// Of the zones and neighbours of a map.
//
// Memory: 4 bytes a zone while it counts.
ByteCount transitions_bytes(const MapCosts& costs);

}  // namespace zonepack
