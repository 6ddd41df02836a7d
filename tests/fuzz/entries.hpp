// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/pack_format/file/checksum.hpp"

// What readers do with bytes that someone made up. Each entry puts the bytes where checksums cannot
// protect them (a digest is as easily forged as the rest) and reads all that the checks let
// through. Any result is right that is not a crash, a read outside the bytes or undefined
// behaviour. Returns whether the checks accepted the bytes.
namespace zonepack::fuzz {

// A pack from its first byte to its last.
bool read_pack(ByteSpan bytes);
// An index, with a right digest around it.
bool read_index(ByteSpan bytes);
// Payload kind (1 byte), first and last signature (uint32 each), a decoded chunk.
bool read_chunk(ByteSpan bytes);
// Payload kind, decoded size (uint32), an LZ4 block, with a right XXH3.
bool read_block(ByteSpan bytes);
// A manifest's FlatBuffer, in a right frame.
bool read_manifest(ByteSpan bytes);
// A DBC file. Every signal that can be asked for is asked for.
bool read_dbc(ByteSpan bytes);

}  // namespace zonepack::fuzz
