// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// Appends a block in the smallest of the forms of FORMAT.md ("Planes") that restores all its bits.
// `blob`: the block as nvblox stores it, bytes_of_block(planes) bytes. What was written is decoded
// again and compared.
void encode_block(std::span<const std::byte> blob, std::uint32_t planes, Bytes& out);

}  // namespace zonepack::packer
