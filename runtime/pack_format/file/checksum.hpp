// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>

#include "platform/base/byte_span.hpp"

// The two checksums of the format. XXH3-64 detects accidental damage and costs next to nothing per
// load; BLAKE2b detects intentional changes and names packs by content.
namespace zonepack {

using Digest16 = std::array<std::uint8_t, 16>;
using Digest32 = std::array<std::uint8_t, 32>;

std::uint64_t xxh3(ByteSpan bytes) noexcept;

Digest16 blake2b_16(ByteSpan bytes) noexcept;

// Of the concatenated parts.
Digest32 blake2b_32(std::initializer_list<ByteSpan> parts) noexcept;

// Lower-case hexadecimal.
std::string to_hex(std::span<const std::uint8_t> bytes);

}  // namespace zonepack
