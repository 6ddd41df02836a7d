// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/pack_format/file/checksum.hpp"

// Like entries.hpp, for what people draw, write and send: whatever the bytes are, reading them ends
// in order, and takes no more memory than kMemoryBound beside the file itself.
namespace zonepack::fuzz {

// A zone file.
bool read_geojson(ByteSpan bytes);
// A robot's settings.
bool read_settings(ByteSpan bytes);
// A database, from its first byte to its last. Accepted when every signature can be packed.
bool read_sqlite(ByteSpan bytes);
// A map of stella_vslam as MessagePack. Accepted when every keyframe can be packed.
bool read_msgpack(ByteSpan bytes);
// A point cloud (PCD), cut into tiles. Accepted when every tile can be packed.
bool read_pcd(ByteSpan bytes);
// An nvblox map. Accepted when every cube can be packed.
bool read_nvblox(ByteSpan bytes);
// Blocks of a recording, sealed with right checksums: for each its kind (1 byte), the size of its
// content (uint32), the content.
bool read_recording(ByteSpan bytes);
// A message of the socket, either way: 0 for a request, else a reply (1 byte), the message.
bool read_message(ByteSpan bytes);

}  // namespace zonepack::fuzz
