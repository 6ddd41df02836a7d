// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/pack_format/pack_generated.h"

// What check_core_chunk() and check_bulk_chunk() decide, written for reading instead of speed:
// FlatBuffers' own verifier, then each rule of FORMAT.md as one line.
namespace zonepack::fuzz {

bool reference_accepts(ByteSpan chunk, const fb::ChunkEntry& entry);

}  // namespace zonepack::fuzz
