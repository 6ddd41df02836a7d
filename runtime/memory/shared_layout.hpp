// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "platform/base/byte_count.hpp"
#include "runtime/memory/slot_pool.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/pack_format/limits.hpp"

// The memory that zoned shares with readers, from its first byte. Integers are in the byte order of
// the machine, which reader and writer share. Offsets count from the first byte.
//
//   header | zones: SharedZone[zone_capacity] | links: u32[slots] | chunks: SharedChunk[slots][8] |
//   slots: 16 KiB each, page-aligned
//
// A reader loads a zone's state; if it is not 0, it follows head and links, copies what it needs or
// reads in place, and loads the state again after an acquire fence: what it read is valid only if
// the state is unchanged. Until then any number it read may belong to another load, so each is
// checked against its bound before use.
namespace zonepack {

inline constexpr std::uint64_t kSharedMagic = 0x3150414D454E4F5Aull;  // "ZONEMAP1"
inline constexpr std::uint32_t kSharedVersion = 1;

struct SharedHeader {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t slot_bytes;
  std::uint32_t zone_capacity;
  std::uint32_t slot_count;
  std::uint64_t zones_at, links_at, chunks_at, slots_at, total_bytes;
  std::atomic<std::uint32_t> epoch;       // incremented at every start of zoned and change of map
  std::atomic<std::uint32_t> zone_count;  // of the map in use
};

struct SharedZone {
  std::atomic<std::uint64_t> state;  // 0: not resident; else epoch << 32 | generation
  std::atomic<std::uint32_t> head;   // first slot
  std::atomic<std::uint32_t> slots;
};

// Where a decoded chunk lies in its slot.
struct alignas(4) SharedChunk {
  std::uint8_t kind = 0;          // PayloadKind
  std::uint8_t offset_lines = 0;  // of kChunkAlignment bytes
  std::uint16_t bytes = 0;        // 0: no further chunk in this slot
};
static_assert(sizeof(SharedChunk) == 4 && kSlotBytes / kChunkAlignment <= 256);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

// Where the tables lie for that many zones and slots.
struct SharedPlaces {
  ByteCount zones = 0, links = 0, chunks = 0, slots = 0, total = 0;
};

constexpr SharedPlaces shared_places(std::uint32_t zone_capacity, std::uint32_t slots) noexcept {
  constexpr ByteCount kPageBytes = 4096;
  constexpr auto rounded = [](ByteCount bytes, ByteCount to) { return (bytes + to - 1) / to * to; };
  SharedPlaces at;
  at.zones = rounded(sizeof(SharedHeader), 64);
  at.links = rounded(at.zones + ByteCount{zone_capacity} * sizeof(SharedZone), 64);
  at.chunks = rounded(at.links + ByteCount{slots} * sizeof(SlotIndex), 64);
  at.slots =
      rounded(at.chunks + ByteCount{slots} * kMaxChunksPerSlot * sizeof(SharedChunk), kPageBytes);
  at.total = at.slots + ByteCount{slots} * kSlotBytes;
  return at;
}

// Bytes that a map of this many zones and slots takes, tables and padding included.
constexpr ByteCount shared_map_bytes(std::uint32_t zone_capacity, std::uint32_t slots) noexcept {
  return shared_places(zone_capacity, slots).total;
}

// Whether a header correctly describes memory of `bytes` bytes.
inline bool shared_header_is_sound(const SharedHeader& header, std::uint64_t bytes) noexcept {
  const SharedPlaces at = shared_places(header.zone_capacity, header.slot_count);
  return header.magic == kSharedMagic && header.version == kSharedVersion &&
         header.slot_bytes == kSlotBytes && header.zones_at == at.zones &&
         header.links_at == at.links && header.chunks_at == at.chunks &&
         header.slots_at == at.slots && header.total_bytes == at.total && at.total == bytes;
}

}  // namespace zonepack
