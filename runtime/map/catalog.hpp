// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
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
  std::string pack;          // file name in the map's folder
  ByteCount pack_bytes = 0;  // of that file
  Digest32 pack_digest{};
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
  PayloadMask payload = 0;  // what will be loaded
  std::vector<CatalogZone> zones;
  std::vector<CatalogPortal> portals;
  ByteCount fixed_bytes = 0;  // charged besides slots (accounting.hpp)

  // Reads FOLDER/manifest.zpm and checks all of it. kNotFound, kIo, and the errors of
  // check_manifest.
  static Result<Catalog> open(const std::string& folder, PayloadMask payload);
  // The same from the manifest's bytes, which must be aligned to 8; the folder may be gone.
  static Result<Catalog> read(ByteSpan manifest, const std::string& folder, PayloadMask payload);

  // What map_costs() gives for the manifest.
  MapCosts costs() const;
  SmallestBudget smallest(std::span<const ZoneId> pinned = {}) const {
    return smallest_budget(costs(), pinned);
  }

  // kNoZone for an unknown name.
  ZoneId find(std::string_view name) const noexcept;
};

}  // namespace zonepack
