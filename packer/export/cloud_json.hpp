// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "packer/export/json_lines.hpp"
#include "packer/record/record.hpp"
#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack::packer {

// Writes one tile of a point cloud as one line: zone, tile, file (or submap; null for a tile cut
// from a file), T_map_base, T_map_points (of the frame of the points: of float32 coordinates the
// file's own), fields ("x", "y", "z", then what there is of "intensity", "rgb", "ring"), points (a
// list of numbers each; rgb as 0x00RRGGBB). What was not packed is null.
void write_tile(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                PayloadMask packed);

}  // namespace zonepack::packer
