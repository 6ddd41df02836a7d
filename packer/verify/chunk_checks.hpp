// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack::packer {

// Checks what readers do not rely on but a packer promises about a decoded chunk that check_chunk()
// has accepted: unused bits are zero, every column and every ordinal is accounted for. Returns the
// first problem found, as the end of a sentence about the chunk.
std::optional<std::string> find_chunk_problem(const fb::ChunkEntry& entry, ByteSpan decoded);

// Whether rows of the chunk are stored as indices of scan points.
bool refers_to_scan(const fb::ChunkEntry& entry, ByteSpan decoded);

}  // namespace zonepack::packer
