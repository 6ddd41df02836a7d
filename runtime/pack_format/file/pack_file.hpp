// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/base/result.hpp"
#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/pack_format/pack_generated.h"

// The layout of a pack file: header, chunks, index, tail. FORMAT.md describes it byte by byte.
namespace zonepack {

inline constexpr std::uint16_t kPackMajor = 1;          // other majors are refused
inline constexpr std::uint16_t kPackMinor = 1;          // greater minors are read: they only add
inline constexpr std::uint16_t kPackMinorOfBlocks = 1;  // packs without blocks are of minor 0

using Magic = std::array<std::uint8_t, 8>;
// As in PNG: a byte that text tools damage, a name, both kinds of line end, end of file.
inline constexpr Magic kPackMagic = {0x89, 'Z', 'P', 'K', '\r', '\n', 0x1A, '\n'};
inline constexpr Magic kPackEndMagic = {'\n', 0x1A, '\n', '\r', 'K', 'P', 'Z', 0x89};

struct PackHeader {
  Magic magic = kPackMagic;
  std::uint16_t major = kPackMajor;
  std::uint16_t minor = 0;
  std::uint32_t reserved = 0;
};
static_assert(sizeof(PackHeader) == 16);

struct PackTail {
  std::uint64_t index_offset = 0;
  std::uint64_t index_size = 0;
  std::uint16_t major = kPackMajor;
  std::uint16_t minor = 0;
  std::uint32_t reserved = 0;
  Digest32 digest{};  // BLAKE2b-256 of the header, the index and this tail up to here
  Magic magic = kPackEndMagic;
};
static_assert(sizeof(PackTail) == 64);

// The digest in the tail, in the manifest and, shortened, in the file's name.
Digest32 pack_digest(const PackHeader& header, ByteSpan index, const PackTail& tail) noexcept;

// Reads and checks the tail of a pack of `file_size` bytes: magic, version, places inside the file.
Result<PackTail> check_tail(ByteSpan last_64_bytes, std::uint64_t file_size) noexcept;

// The longest index of a pack with so many chunks, in bytes: what is charged for it.
inline constexpr ByteCount kIndexBytesPerPack = 512;
constexpr ByteCount most_index_bytes(std::uint64_t chunks) noexcept {
  return kIndexBytesPerPack + chunks * sizeof(fb::ChunkEntry);
}

// Checks header, index and tail of a pack: limits (kTooLarge, see over_limit), digest, FlatBuffers
// structure, and that the chunks' stored bytes follow each other without gap or overlap from the
// header to the index. `index` must be aligned to 8. On success the returned index points into
// `index`.
Result<const fb::PackIndex*> check_index(ByteSpan header_16_bytes, ByteSpan index,
                                         const PackTail& tail) noexcept;

// What check_tail() or check_index() found wrong with an index, for people; says neither the file
// nor what to do.
std::string index_fault_text(const Error& error);

// Checks the stored bytes of a chunk (length, XXH3) and decodes them to exactly
// entry.decoded_size() bytes at `out`, which must be aligned to 16 and have kSlotBytes of room;
// then checks the structure. No allocation. `stored` must be private memory: bytes that change
// meanwhile defeat the checks. A raw chunk may already be at `out`.
Result<ByteSpan> decode_chunk(const fb::ChunkEntry& entry, ByteSpan stored,
                              std::byte* out) noexcept;

// Places chunks into slots back to back in index order: each after the previous one if it fits into
// the same slot, else at the start of a new one.
class Placement {
 public:
  struct Place {
    std::uint32_t slot;    // 0, 1, 2 … of the zone
    std::uint32_t offset;  // bytes into the slot
  };
  Place add(std::uint32_t decoded_size) noexcept;
  // The size of the longest chunk that still fits the last slot; 0 without slots and when it is
  // full.
  std::uint64_t room() const noexcept;
  std::uint32_t slots() const noexcept { return slots_; }

 private:
  std::uint32_t slots_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint64_t end_ = 0;
};

// `wanted` with what it implies: the core always, the scan when grid cells refer to it.
constexpr PayloadMask payload_closure(PayloadMask wanted, bool grid_needs_scan) noexcept {
  wanted |= kCoreOnly;
  if (grid_needs_scan && (wanted & mask_of(fb::PayloadKind::Grid)) != 0) {
    wanted |= mask_of(fb::PayloadKind::Scan);
  }
  return wanted;
}

// Slots that a pack's chunks of these kinds fill.
std::uint32_t slots_needed(const fb::PackIndex& index, PayloadMask wanted) noexcept;

}  // namespace zonepack
