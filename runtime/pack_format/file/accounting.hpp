// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/pack_format/limits.hpp"

// What a map costs in memory, counted the same way by the packer's plan and by the robot, so that
// the robot keeps any budget that plan promises.
namespace zonepack {

// What the runtime's own tables take per item; a test compares them with the real allocations.
inline constexpr ByteCount kTableBytesPerZone = 640;    // catalog, residency, keeper, graph
inline constexpr ByteCount kTableBytesPerNameByte = 4;  // two names, the pack's name, rounding
inline constexpr ByteCount kTableBytesPerRing = 96;
inline constexpr ByteCount kTableBytesPerVertex = 32;
inline constexpr ByteCount kTableBytesPerPortal = 192;
inline constexpr ByteCount kTableBytesPerSlot = 96;  // chain, places of chunks
inline constexpr ByteCount kTableBytesPerMap = 16 * kKiB;
// Stored bytes of chunks being loaded into slots; the index of the pack being read comes on top.
inline constexpr ByteCount kReadBufferBytes = 64 * kKiB;
inline constexpr ByteCount kIndexBytesPerChunk = 96;  // its entry, and where it was loaded to
// While a manifest is read, its bytes are held this many times: the file, and its copy and blocks
// in a recording. The first kFreeMapBytes of that are part of the program's own memory, the 12 MiB
// besides the budget; the rest is charged.
inline constexpr ByteCount kManifestHeldTimes = 3;
inline constexpr ByteCount kFreeMapBytes = 2 * kMiB;

using ZonePair = std::pair<ZoneId, ZoneId>;

struct MapCosts {
  ByteCount fixed_bytes = 0;              // besides slots and their tables
  std::vector<std::uint32_t> zone_slots;  // by ZoneId, for the payload asked for
  std::vector<ZonePair> neighbours;       // one per portal
};

// Bytes of a zone's chunks of these kinds, and of the kinds that they imply (payload_closure).
struct ChunkBytes {
  ByteCount stored = 0;
  ByteCount decoded = 0;
};
ChunkBytes chunk_bytes(const fb::Zone& zone, PayloadMask wanted) noexcept;

// Chunks of all kinds in a zone's pack.
std::uint64_t chunk_count(const fb::Zone& zone) noexcept;

constexpr ByteCount manifest_charge(ByteCount file_bytes) noexcept {
  const ByteCount held = kManifestHeldTimes * file_bytes;
  return held > kFreeMapBytes ? held - kFreeMapBytes : 0;
}

// The tables and read buffers that a checked manifest asks for, without allocating any.
ByteCount table_bytes(const fb::Manifest& manifest) noexcept;

// Costs of a checked manifest, whose file has so many bytes, when these kinds are loaded.
// Memory: 4 bytes a zone and 8 bytes a portal, less than table_bytes() counts for them.
MapCosts map_costs(const fb::Manifest& manifest, ByteCount file_bytes, PayloadMask wanted);

// All charged bytes when `slots` slots exist.
constexpr ByteCount charged_with(ByteCount fixed_bytes, std::uint64_t slots) noexcept {
  return fixed_bytes + slots * (kSlotBytes + kTableBytesPerSlot);
}

// The most slots that a budget covers besides the fixed bytes.
constexpr std::uint64_t slots_within(ByteCount budget, ByteCount fixed_bytes) noexcept {
  return budget < fixed_bytes ? 0 : (budget - fixed_bytes) / (kSlotBytes + kTableBytesPerSlot);
}

// The zone and the neighbour that together take most besides the pinned zones, which are always
// held; `amounts` are slots or signatures by ZoneId.
struct LargestPair {
  std::uint64_t amount = 0;
  ZoneId zone_a = kNoZone;
  ZoneId zone_b = kNoZone;  // kNoZone: the largest zone has no neighbour that matters
};
LargestPair largest_pair(std::span<const std::uint32_t> amounts,
                         std::span<const ZonePair> neighbours, std::span<const ZoneId> pinned);

struct SmallestBudget {
  ByteCount bytes = 0;
  std::uint64_t slots = 0;  // of the pair and of the pinned zones
  LargestPair pair;
};

// The smallest budget under which every zone fits together with any one neighbour, all pinned
// zones, tables and read buffers. Both plan and the robot use this function.
SmallestBudget smallest_budget(const MapCosts& costs, std::span<const ZoneId> pinned);

}  // namespace zonepack
