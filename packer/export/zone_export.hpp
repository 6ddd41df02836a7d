// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "packer/decode/map_reader.hpp"
#include "packer/export/json_lines.hpp"

namespace zonepack::packer {

// Writes every signature of a zone as a line, in order of id. Throws std::runtime_error naming the
// pack; whole lines may have been written by then.
//
// Memory: the pack's index, a window of signatures (about `window_bytes` decoded, or one signature
// if that is longer) and a piece of JSON.
void export_zone(const MapReader& map, const fb::Zone& zone, JsonLines& json,
                 ByteCount window_bytes = 8 * kMiB);

}  // namespace zonepack::packer
