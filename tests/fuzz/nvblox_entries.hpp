// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "packer/record/record.hpp"
#include "platform/base/byte_span.hpp"

// What readers of nvblox maps do with bytes that someone made up; as in entries.hpp.
namespace zonepack::fuzz {

// Planes of a block (1 byte), a block of voxels as a pack holds it. Its size stands nowhere else.
bool read_voxels(ByteSpan bytes);
// A block as nvblox stores it, of any length: encoded, decoded, the same.
bool read_plain_voxels(ByteSpan bytes);
// What a pack says of the layers of blocks.
bool read_layers(ByteSpan bytes);

struct NvbloxSeeds {
  std::vector<packer::Bytes> voxels, files, layers;
};
const NvbloxSeeds& nvblox_seeds();

}  // namespace zonepack::fuzz
