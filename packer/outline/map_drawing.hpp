// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "packer/outline/map_image.hpp"
#include "packer/record/map_source.hpp"
#include "packer/record/source_kind.hpp"

namespace zonepack::packer {

// The floor plan of a map, and where it comes from.
struct MapDrawing {
  MapImage image;      // without cells when nothing is known
  std::string source;  // "local grids", "a slice"
  std::string detail;  // "0.2 to 1.5 m above the floor at z 0.01"; empty: there is none
  std::size_t grids = 0;
  std::vector<std::string> warnings;
  std::string missing;  // why there are no cells, and what to do: "no local grids, ..."
  double yaw_rad = 0;   // of its rows around its lower left corner, as in GridFile

  std::string origin() const { return detail.empty() ? source : source + " " + detail; }
  // For a picture that is drawn without a floor plan: adds a warning that names the map.
  void warn_if_missing(const std::string& map);
};

using SeeSignature = std::function<void(const SignatureRecord&)>;
// Shows every signature that can be read, with the payloads wanted.
using EachSignature = std::function<void(const PayloadSet& wanted, const SeeSignature& see)>;

// What the local grids of signatures add up to or, where there are none, a slice of what else they
// show (Slice). `each` is called up to three times. Throws std::runtime_error where the local grids
// are too far apart.
MapDrawing drawing_of(const EachSignature& each, const SliceHeights& slice);

// The database's own map or, without one, what its signatures show; leaves out those that are
// damaged, with a warning. Throws std::runtime_error as above.
MapDrawing drawing_of(MapSource& source, const SliceHeights& slice = {});

}  // namespace zonepack::packer
