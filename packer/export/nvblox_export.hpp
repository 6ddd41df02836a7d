// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "packer/decode/map_reader.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack::packer {

// Writes zones of an nvblox map as a map that nvblox loads: the tables of every layer as the source
// had them, its metadata, and the zones' blocks in the rows that they had. The file appears whole
// or not at all. Throws std::runtime_error: not a map of blocks, or the file cannot be written.
//
// Memory: a window of signatures; SQLite writes the rest.
void export_nvblox(const MapReader& map, std::span<const ZoneId> zones, const std::string& out);

}  // namespace zonepack::packer
