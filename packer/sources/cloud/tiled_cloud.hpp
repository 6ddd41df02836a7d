// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "packer/record/source_kind.hpp"
#include "packer/sources/cloud/cloud_map.hpp"

namespace zonepack::packer {

// A PCD file cut into square tiles of options.tile_m, aligned with the map's axes, and along the
// borders of zones where options.zone_at knows them. The file is read twice, the points wait in a
// temporary file.
//
// Memory: 16 MiB, and 100 bytes a tile, of which there are at most a million.
std::unique_ptr<CloudMap> open_tiled_cloud(const SourceOptions& options);

}  // namespace zonepack::packer
