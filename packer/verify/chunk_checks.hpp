// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack::packer {

// What reading does not rely on but a packer promises of a decoded chunk that check_chunk() has
// passed: nothing unused but zero, every column and every ordinal accounted for. Returns what is
// wrong, or nothing.
std::optional<std::string> find_chunk_problem(const fb::ChunkEntry& entry, ByteSpan decoded);

// Whether rows of the chunk are told as points of the scan.
bool refers_to_scan(const fb::ChunkEntry& entry, ByteSpan decoded);

}  // namespace zonepack::packer
