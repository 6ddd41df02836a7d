// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/localize/features/detector_settings.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack::localize {

// What a map's manifest says: its zones, and what found its features.
struct StoredMap {
  Catalog catalog;
  DetectorSettings detector;
};
Outcome<StoredMap> open_stored_map(const std::string& folder);

// One zone's pack, read and decoded as far as wanted; errors name the file and the zone.
Outcome<DecodedPack> decode_zone(const Catalog& catalog, const CatalogZone& zone,
                                 PayloadMask wanted);

// The features of one zone, read from its pack.
Outcome<std::vector<MapFeatures>> read_zone_features(const StoredMap& map, ZoneId zone);

}  // namespace zonepack::localize
