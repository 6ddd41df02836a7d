// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "packer/record/map_outline.hpp"

// Where the signatures of a source stand in the map.
namespace zonepack::packer {

// What becomes of signatures without an optimised pose. kOdometry leaves out sessions of which
// nothing has an optimised pose while others have: their odometry starts at a place of its own.
enum class UnlinkedPolicy : std::uint8_t { kOdometry, kDrop, kError, kOdometryAll };

struct PlacedSignature {
  const NodeOutline* node = nullptr;
  Transform T_map_base{};
};

struct Placing {
  std::vector<PlacedSignature> placed;                         // by id, without damaged ones
  std::map<std::int32_t, std::size_t> unconnected_by_session;  // left out with kOdometry
  std::size_t dropped = 0;                                     // without a pose, or left out
};

// `outline` outlives the result.
Placing place_signatures(const MapOutline& outline, UnlinkedPolicy policy);

}  // namespace zonepack::packer
