// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/base/result.hpp"
#include "platform/files/storage.hpp"
#include "runtime/pack_format/file/accounting.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

struct CatalogZone {
  std::string name;
  std::string zone_type;
  Polygon polygon;
  std::uint32_t signatures = 0;
  std::uint32_t slots = 0;     // for the payload the catalog was opened for
  ByteCount stored_bytes = 0;  // to read for that payload
  ByteCount decoded_bytes = 0;
  std::uint64_t chunks = 0;  // of all kinds in the pack, as the manifest says
  std::string pack;          // file name in the map's folder
  ByteCount pack_bytes = 0;  // of that file
  Digest32 pack_digest{};
  std::uint8_t layer = kNoLayer;  // index into Catalog::layers
  bool loadable = true;           // false: of a layer that was not chosen; it charges nothing

  static constexpr std::uint8_t kNoLayer = 255;
};

struct CatalogPortal {
  std::string name;
  ZoneId zone_a = kNoZone;
  ZoneId zone_b = kNoZone;
  Segment2 segment;
};

// What exists: the zones of a map and what each costs for a payload, read once from the manifest. A
// ZoneId is an index into `zones`, which is sorted by name. Immutable after open(); may be read by
// any thread.
struct Catalog {
  std::string folder;
  Digest16 lineage{};
  Digest32 version{};       // digest of the manifest
  std::string detector;     // of its features; empty when it is over kMostDetectorBytes
  PayloadMask payload = 0;  // what will be loaded
  std::vector<CatalogZone> zones;
  std::vector<CatalogPortal> portals;
  std::vector<std::string> layers;  // of zones, sorted; at most kNoLayer, the first by name
  ByteCount fixed_bytes = 0;        // charged besides slots (accounting.hpp)
  ByteCount reading_bytes = 0;      // that reading the manifest takes, whether charged or not

  // What it takes to read this map and to hold its tables.
  ByteCount bytes_to_open() const noexcept {
    return fixed_bytes + std::min(reading_bytes, kFreeMapBytes);
  }

  // Reads FOLDER/manifest.zpm and checks all of it. kNotFound, kIo, and the errors of
  // check_manifest. kNoRoom: reading the manifest and holding its tables would take more than
  // `most`; nothing of that size was allocated. The message says what is wrong (entry, zone, field,
  // value, limit, bytes); the caller adds which map it was for, and what to do.
  static Outcome<Catalog> open(const std::string& folder, PayloadMask payload,
                               ByteCount most = kNoMost);
  // The same from the manifest's bytes, which must be aligned to 8; the folder may be gone.
  static Outcome<Catalog> read(ByteSpan manifest, const std::string& folder, PayloadMask payload,
                               ByteCount most = kNoMost);

  // Leaves zones of other layers out of what is loaded and charged; they stay on the plan. Zones
  // without a layer, and an empty choice, leave all as it is. The message names a layer that no
  // zone has (kNotFound).
  Outcome<void> choose_layers(const std::vector<std::string>& names);

  static constexpr std::size_t kMostDetectorBytes = 2048;
  static constexpr ByteCount kNoMost = std::numeric_limits<ByteCount>::max();

  // What map_costs() gives for the manifest.
  MapCosts costs() const;
  SmallestBudget smallest(std::span<const ZoneId> pinned = {}) const {
    return smallest_budget(costs(), pinned);
  }

  // kNoZone for an unknown name.
  ZoneId find(std::string_view name) const noexcept;
};

// The bytes of FOLDER/manifest.zpm, with the errors and messages of Catalog::open: where reading it
// would take more than `most`, or the file is longer than the format allows, nothing is read.
Outcome<std::vector<std::byte>> read_manifest_file(const std::string& folder, ByteCount most,
                                                   ReadMode mode);

}  // namespace zonepack
