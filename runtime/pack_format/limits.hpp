// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "platform/base/byte_count.hpp"

// Limits of the format. A packer refuses a map beyond them by name; a reader refuses a
// file beyond them. FORMAT.md gives the reasons.
namespace zonepack {

// One slot of the arena, and the longest decoded chunk. The same for every map, so that two maps
// can share an arena.
inline constexpr ByteCount kSlotBytes = 16 * kKiB;

// Decoded chunks start at multiples of this inside a slot.
inline constexpr ByteCount kChunkAlignment = 64;

// A bulk chunk's bytes end with this many zero bytes, so that a packed value is read as one word.
inline constexpr ByteCount kColumnPadding = 8;

inline constexpr std::uint32_t kMaxChunksPerSlot = 8;
inline constexpr std::uint32_t kMaxChunksPerPack = 1u << 22;  // 64 GiB decoded
inline constexpr std::uint32_t kMaxSignaturesPerZone = 1u << 24;
inline constexpr std::uint32_t kMaxRowsPerTable = 1u << 30;  // points of a scan, bytes of an image
inline constexpr std::uint32_t kMaxZones = 1u << 20;
inline constexpr std::uint32_t kMaxPortals = 1u << 21;
inline constexpr std::uint32_t kMaxPortalsPerZone = 256;
inline constexpr std::uint32_t kMaxVerticesPerZone = 4096;  // all rings together
inline constexpr std::uint32_t kMaxNameBytes = 64;
inline constexpr ByteCount kMaxIndexBytes = 512 * kMiB;
inline constexpr ByteCount kMaxManifestBytes = 512 * kMiB;

}  // namespace zonepack
