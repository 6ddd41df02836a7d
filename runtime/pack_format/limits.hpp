// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"

// Limits of the format, in one table for packer, verify and robot: each refuses what is beyond a
// row by the row's name, with the value found and the limit. FORMAT.md shows the same rows and
// gives the reasons; a test holds it to this table, and all three to each row.
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
inline constexpr std::uint32_t kMaxPackNameBytes = 255;  // what file systems hold
inline constexpr std::uint32_t kMaxPayloadKinds = 8;     // besides the core
inline constexpr ByteCount kMaxCoreBlobBytes = 4096;
inline constexpr ByteCount kMaxIndexBytes = 512 * kMiB;
inline constexpr ByteCount kMaxManifestBytes = 512 * kMiB;

enum class LimitId : std::uint8_t {
  kDecodedBytes,
  kStoredBytes,
  kChunksOfSlot,
  kChunksOfPack,
  kSlotsOfZone,
  kSignaturesOfZone,
  kRowsOfTable,
  kZones,
  kPortals,
  kPortalsOfZone,
  kVerticesOfZone,
  kNameBytes,
  kPackNameBytes,
  kPayloadKinds,
  kCoreBlobBytes,
  kIndexBytes,
  kManifestBytes,
};
inline constexpr std::size_t kLimitCount = 17;

// Whether one of the three holds a map to a limit.
struct Holding {
  const char* exempt = nullptr;  // why nothing beyond can reach or harm it; null: it refuses
  constexpr bool refuses() const noexcept { return exempt == nullptr; }
};

struct Limit {
  LimitId id;
  const char* name;  // what a refusal and FORMAT.md call it
  std::uint64_t most;
  Holding packer, verify, robot;
  const char* remedy;  // what to do when packing refuses
};

namespace limits {
inline constexpr Holding kRefuses{};
inline constexpr Holding kCutToFit{"the packer cuts chunks to what a slot holds"};
inline constexpr Holding kPlaced{"readers place chunks themselves, never more than this in a slot"};
inline constexpr Holding kFewerThanChunks{"each slot holds a chunk, so chunks reach their limit"};
inline constexpr Holding kShortSource{"no value of a source is longer than 257 MiB"};
inline constexpr Holding kNamedByPacker{"the packer makes the name: a zone's and 21 bytes"};
inline constexpr Holding kKnownKinds{"the packer knows seven kinds besides the core"};
inline constexpr Holding kInsideChunk{"a reader only hands it on, and its chunk bounds it"};
inline constexpr Holding kChunksBoundIt{"the most chunks of a pack take 289 MiB of index"};
inline constexpr const char* kSplit = "split the zone with --max-zone-bytes";
inline constexpr const char* kReport = "report this as a bug of zonepack";
}  // namespace limits

inline constexpr std::array<Limit, kLimitCount> kLimits = {{
    {LimitId::kDecodedBytes, "decoded bytes of a chunk", kSlotBytes, limits::kCutToFit,
     limits::kRefuses, limits::kRefuses, limits::kReport},
    {LimitId::kStoredBytes, "stored bytes of a chunk", kSlotBytes, limits::kCutToFit,
     limits::kRefuses, limits::kRefuses, limits::kReport},
    {LimitId::kChunksOfSlot, "chunks in a slot", kMaxChunksPerSlot, limits::kPlaced,
     limits::kPlaced, limits::kPlaced, limits::kReport},
    {LimitId::kChunksOfPack, "chunks in a pack", kMaxChunksPerPack, limits::kRefuses,
     limits::kRefuses, limits::kRefuses, limits::kSplit},
    {LimitId::kSlotsOfZone, "slots of a zone", kMaxChunksPerPack, limits::kFewerThanChunks,
     limits::kRefuses, limits::kRefuses, limits::kSplit},
    {LimitId::kSignaturesOfZone, "signatures in a zone", kMaxSignaturesPerZone, limits::kRefuses,
     limits::kRefuses, limits::kRefuses, limits::kSplit},
    {LimitId::kRowsOfTable, "rows in a table", kMaxRowsPerTable, limits::kShortSource,
     limits::kRefuses, limits::kRefuses, limits::kReport},
    {LimitId::kZones, "zones", kMaxZones, limits::kRefuses, limits::kRefuses, limits::kRefuses,
     "draw fewer zones, or give a larger --max-zone-bytes"},
    {LimitId::kPortals, "portals", kMaxPortals, limits::kRefuses, limits::kRefuses,
     limits::kRefuses, "draw fewer portals or zones"},
    {LimitId::kPortalsOfZone, "portals of a zone", kMaxPortalsPerZone, limits::kRefuses,
     limits::kRefuses, limits::kRefuses, "divide the zone into several"},
    {LimitId::kVerticesOfZone, "vertices of a zone", kMaxVerticesPerZone, limits::kRefuses,
     limits::kRefuses, limits::kRefuses,
     "simplify its outline (QGIS: Vector > Geometry Tools > Simplify)"},
    {LimitId::kNameBytes, "bytes of a zone's name", kMaxNameBytes, limits::kRefuses,
     limits::kRefuses, limits::kRefuses, "give the zone a shorter name"},
    {LimitId::kPackNameBytes, "bytes of a pack's file name", kMaxPackNameBytes,
     limits::kNamedByPacker, limits::kRefuses, limits::kRefuses, limits::kReport},
    {LimitId::kPayloadKinds, "payload kinds besides the core", kMaxPayloadKinds,
     limits::kKnownKinds, limits::kRefuses, limits::kRefuses, limits::kReport},
    {LimitId::kCoreBlobBytes, "bytes of a label, velocity, gps, env_sensors or calibration",
     kMaxCoreBlobBytes, limits::kRefuses, limits::kRefuses, limits::kInsideChunk,
     "leave the signature out with --damaged skip"},
    {LimitId::kIndexBytes, "bytes of a pack's index", kMaxIndexBytes, limits::kChunksBoundIt,
     limits::kRefuses, limits::kRefuses, limits::kSplit},
    {LimitId::kManifestBytes, "bytes of a manifest's FlatBuffer", kMaxManifestBytes,
     limits::kRefuses, limits::kRefuses, limits::kRefuses,
     "draw fewer zones, or pack fewer signatures"},
}};

constexpr const Limit& limit(LimitId id) noexcept { return kLimits[static_cast<std::size_t>(id)]; }

static_assert(
    [] {
      for (std::size_t i = 0; i < kLimitCount; ++i) {
        if (kLimits[i].id != static_cast<LimitId>(i)) return false;
      }
      return true;
    }(),
    "each row stands at its id");

// A value beyond a row.
struct Excess {
  LimitId id = LimitId::kZones;
  std::uint64_t found = 0;
};

constexpr bool is_over(LimitId id, std::uint64_t found) noexcept { return found > limit(id).most; }

// kTooLarge with the row and the value in its detail, which is negative: a positive detail of
// kTooLarge is a need of bytes. Values from 2^48 on are said to be 2^48 - 1.
Error over_limit(LimitId id, std::uint64_t found) noexcept;
std::optional<Excess> excess_of(const Error& error) noexcept;

// "vertices of a zone: 4097, the format holds at most 4096".
std::string to_string(const Excess& excess);

}  // namespace zonepack
