// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>

#include "packer/record/source_kind.hpp"
#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {

struct CheckZonesOptions {
  std::string zones;                    // GeoJSON
  std::optional<SourceOptions> source;  // counts signatures when given
  double snap_m = kDefaultSnap_m;
  std::string out = {};   // a picture of the zones, .html, .svg or .png; empty: none
  std::string grid = {};  // of map_server, to draw below the zones; empty: the source's own
};

// Reports every fault and warning of a zone file at once, its zones and portals and, with a
// database, how many signatures each zone holds and which are in none; draws them, if asked, over
// the database's occupancy grid or the one given. Writes text for people to `text`, faults last,
// and the same content to `json`. Returns the exit code: 0 without faults, else 1. Throws
// std::runtime_error when a file cannot be read.
int check_zones(const CheckZonesOptions& options, std::ostream& text, nlohmann::ordered_json& json);

// `zonepack check-zones ZONES.geojson [--db DB] [--grid map.yaml] [--snap METRES] [--out FILE]
// [--json FILE]`.
void add_check_zones_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
