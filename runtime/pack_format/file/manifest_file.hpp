// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/pack_format/file/manifest_fault.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/pack_format/manifest_generated.h"

// The layout of the manifest file: header, one FlatBuffer, tail with the digest of both.
namespace zonepack {

inline constexpr std::string_view kManifestName = "manifest.zpm";
inline constexpr std::uint16_t kManifestMajor = 1;
// What a reader knows. A manifest without layers and changes is of minor version 0, byte for byte
// what it was before there were any.
inline constexpr std::uint16_t kManifestMinor = 1;
inline constexpr std::uint16_t kManifestMinorOfLayers = 1;
inline constexpr std::uint32_t kMaxLayers = 64;
inline constexpr std::uint32_t kMaxSessionRanges = 4096;  // of one layer
inline constexpr std::uint32_t kMaxChanges = 1024;
inline constexpr std::uint32_t kSignatureBytes = 64;  // Ed25519

inline constexpr Magic kManifestMagic = {0x89, 'Z', 'P', 'M', '\r', '\n', 0x1A, '\n'};
inline constexpr Magic kManifestEndMagic = {'\n', 0x1A, '\n', '\r', 'M', 'P', 'Z', 0x89};

struct ManifestHeader {
  Magic magic = kManifestMagic;
  std::uint16_t major = kManifestMajor;
  std::uint16_t minor = 0;
  std::uint32_t size = 0;  // of the FlatBuffer that follows
};
static_assert(sizeof(ManifestHeader) == 16);

struct ManifestTail {
  Digest32 digest{};  // BLAKE2b-256 of the header and the FlatBuffer
  Magic magic = kManifestEndMagic;
};
static_assert(sizeof(ManifestTail) == 40);

inline constexpr ByteCount kManifestFrameBytes = sizeof(ManifestHeader) + sizeof(ManifestTail);
inline constexpr ByteCount kMaxManifestFileBytes = kMaxManifestBytes + kManifestFrameBytes;

// Checks a whole manifest file and everything that its readers rely on: digest, structure, names
// (present, unique, sorted), all limits that a manifest can break, polygons, portals and edges
// between known zones, slot tables, texts without control characters, file names without a path,
// and no bytes that nothing refers to. `file` must be aligned to 8. The result points into `file`.
// `fault` receives what is wrong and where.
Result<const fb::Manifest*> check_manifest(ByteSpan file, ManifestFault* fault = nullptr) noexcept;

// The digest at the end of a checked manifest file, which names the version of the map.
Digest32 manifest_digest(ByteSpan file) noexcept;

Polygon polygon_of(const fb::Zone& zone);

// zone.slots() holds one count for every set of packed kinds other than the core: the bits of
// `payload_mask` without bit 0, squeezed together, are its index.
std::uint32_t slot_table_index(PayloadMask wanted, PayloadMask packed) noexcept;

// Slots that the zone charges when these kinds are loaded; kinds that were not packed cost nothing.
std::uint32_t zone_slots(const fb::Manifest& manifest, const fb::Zone& zone,
                         PayloadMask wanted) noexcept;

}  // namespace zonepack
