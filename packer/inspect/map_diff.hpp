// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/decode/map_reader.hpp"

// What one version of a map has that another has not.
namespace zonepack::packer {

struct ZoneDiff {
  enum class Kind : std::uint8_t { kAdded, kRemoved, kChanged, kRedrawn };
  std::string name;
  Kind kind = Kind::kChanged;
  std::uint32_t signatures_before = 0, signatures_after = 0;
  ByteCount pack_bytes_before = 0, pack_bytes_after = 0;
  std::string pack;  // to be fetched; empty: none
};

struct MapDiff {
  std::string version_before, version_after;
  bool same_map = false;        // of one lineage, so that a robot takes it while it drives
  std::vector<ZoneDiff> zones;  // sorted by name; kRedrawn: same pack, other outline or texts
  std::size_t unchanged = 0;    // zones
  std::size_t portals_added = 0, portals_removed = 0;
  bool layers_changed = false;
  std::uint64_t signatures_before = 0, signatures_after = 0;
  ByteCount pack_bytes_before = 0, pack_bytes_after = 0;
  std::size_t fetch_packs = 0;  // that the map before does not name
  ByteCount fetch_pack_bytes = 0;
  ByteCount fetch_manifest_bytes = 0;  // 0 when the version is the same
};

MapDiff diff_maps(const MapReader& before, const MapReader& after);

}  // namespace zonepack::packer
