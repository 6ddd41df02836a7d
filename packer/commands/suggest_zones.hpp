// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>

#include "packer/record/source_kind.hpp"
#include "platform/base/byte_count.hpp"

namespace zonepack::packer {

struct SuggestZonesOptions {
  std::optional<SourceOptions> source;  // without a grid, its own is taken
  std::string grid;                     // of map_server; empty: none
  std::string out;                      // zones.geojson
  std::string preview;                  // .html, .svg or .png; empty: none
  std::string method = "basins";
  double door_ratio = 0.8;
  double min_area_m2 = 1.5;
  double max_length_m = 0;       // 0: any
  ByteCount max_zone_bytes = 0;  // 0: any; needs a database
};

// Writes zones and portals for a database's occupancy grid, or one of map_server. Throws
// std::runtime_error.
void suggest_zones(const SuggestZonesOptions& options, std::ostream& text,
                   nlohmann::ordered_json& json);

// `zonepack suggest-zones (--db DB | --grid map.yaml) --out zones.geojson`; sets exit_code when it
// has run.
void add_suggest_zones_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
