// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "packer/export/json_lines.hpp"
#include "packer/record/record.hpp"
#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack::packer {

// Writes each block of a cube of an nvblox map as one line, in order of index: zone, cube (the
// signature's id), index [x, y, z], corner (metres, in the map), block_size, tsdf_layer,
// color_layer, occupancy_layer, esdf_layer (base64 of the block as nvblox stores it; null where the
// layer has none). Where blocks were not packed, one line for the cube with nulls.
void write_blocks(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                  PayloadMask packed);

}  // namespace zonepack::packer
