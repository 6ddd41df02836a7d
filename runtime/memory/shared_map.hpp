// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "runtime/memory/slot_pool.hpp"
#include "runtime/memory/zone_directory.hpp"
#include "runtime/pack_format/checksum.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/pack_format/limits.hpp"

// The memory that zoned shares with readers, from its first byte. All integers are those of the
// machine; reader and writer run on the same one. Offsets count from the first byte.
//
//   header | zones: SharedZone[zone_capacity] | links: u32[slots] | chunks: SharedChunk[slots][8] |
//   slots: 16 KiB each, page-aligned
//
// A reader takes a zone's state; if it is not 0 it follows head and links, copies what it needs or
// reads in place, and takes the state again, behind an acquire fence: what was read is valid only
// if the state is the same. Until then every number read may be of another load, so each is held
// against its bound before it is used.
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
  std::atomic<std::uint32_t> epoch;       // one more with every start of zoned and change of map
  std::atomic<std::uint32_t> zone_count;  // of the map in use
};

struct SharedZone {
  std::atomic<std::uint64_t> state;  // 0: not resident; else epoch << 32 | generation
  std::atomic<std::uint32_t> head;   // first slot
  std::atomic<std::uint32_t> slots;
};

// Where a decoded chunk stands in its slot.
struct SharedChunk {
  std::uint8_t kind = 0;          // PayloadKind
  std::uint8_t offset_lines = 0;  // of kChunkAlignment bytes
  std::uint16_t bytes = 0;        // 0: no further chunk in this slot
};
static_assert(sizeof(SharedChunk) == 4 && kSlotBytes / kChunkAlignment <= 256);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

// Bytes that a map of this many zones and slots takes, tables and padding included.
ByteCount shared_map_bytes(std::uint32_t zone_capacity, std::uint32_t slots) noexcept;

// Whether a header describes memory of `bytes` bytes soundly; for readers.
bool shared_header_is_sound(const SharedHeader& header, std::uint64_t bytes) noexcept;

// The writer's side. Ownership: refers to memory that outlives it.   Threads: publish() and
// withdraw() by the control thread; slots, links and chunk places by the loader, which owns a slot
// until its zone is published and again after the zone was withdrawn. Real-time: nothing allocates.
class SharedMap final : public ZoneDirectory {
 public:
  // Lays out zeroed memory of shared_map_bytes(), or takes over memory laid out before for the same
  // numbers: every zone is withdrawn, and a new epoch begins. kMismatch when it was laid out for
  // others.
  static Result<SharedMap> lay_out(std::span<std::byte> memory, std::uint32_t zone_capacity,
                                   std::uint32_t slots);

  void publish(ZoneId zone, std::uint32_t generation, const SlotChain& slots) noexcept override;
  void withdraw(ZoneId zone) noexcept override;

  // All zones are withdrawn and another map's take their places. kTooLarge beyond the capacity.
  Result<void> begin_map(std::uint32_t zones) noexcept;

  std::uint32_t slot_count() const noexcept { return header_->slot_count; }
  std::uint32_t zone_capacity() const noexcept { return header_->zone_capacity; }
  std::span<std::byte> slot(SlotIndex index) noexcept;
  std::span<SlotIndex> links() noexcept;
  std::span<SharedChunk, kMaxChunksPerSlot> chunks(SlotIndex slot) noexcept;

 private:
  explicit SharedMap(std::byte* memory) noexcept;

  std::byte* memory_;
  SharedHeader* header_;
  SharedZone* zones_;
};

}  // namespace zonepack
