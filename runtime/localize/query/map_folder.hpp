// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/localize/features/detector_settings.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/map/catalog.hpp"

namespace zonepack::localize {

// What a map's manifest says: its zones, and what found its features.
struct MapFolder {
  Catalog catalog;
  DetectorSettings detector;
};
Outcome<MapFolder> open_map_folder(const std::string& folder);

// The features of one zone, read from its pack.
Outcome<std::vector<MapFeatures>> read_zone_features(const MapFolder& map, ZoneId zone);

}  // namespace zonepack::localize
