// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "packer/outline/map_drawing.hpp"
#include "packer/record/source_kind.hpp"
#include "packer/suggest/suggest.hpp"
#include "packer/zones/partition.hpp"

// What suggest-zones draws zones on: a floor plan and the signatures on it.
namespace zonepack::packer {

struct SuggestGround {
  MapDrawing drawing;
  std::vector<SignaturePlace> places;  // of a map; none of a grid alone
  std::vector<std::int32_t> sessions;  // parallel
};

// Of a map, a grid of map_server (empty: none) that stands for the map's own, or both. Throws
// std::runtime_error, also where the map has no floor plan of its own.
SuggestGround read_ground(const std::optional<SourceOptions>& from, const std::string& grid);

// With a margin of one cell that is not free. Throws std::runtime_error of a plan too large.
suggest::FreeSpace free_space_of(const MapImage& image);

// Where that space, with its margin, lies in the map.
suggest::GridPlace place_of(const SuggestGround& ground);

struct PathRule {
  enum By { kMetres, kSignatures } by;
  double size;
};

// The signatures by id, cut into stretches of so many metres or signatures.
std::vector<suggest::PathPlace> path_of(const SuggestGround& ground,
                                        const suggest::FreeSpace& space,
                                        const suggest::GridPlace& place, const PathRule& rule);

}  // namespace zonepack::packer
