// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "packer/zones/findings.hpp"
#include "packer/zones/zone_plan.hpp"

// Reads the zone file: a GeoJSON FeatureCollection in metres of the map frame.
//
// Zones: Polygon features (holes allowed, rings closed) with properties
//   name       required, unique; see find_name_problem()
//   zone_type  ("ward"; a zone without one gives a warning), label, layer, floor: text, optional
//   z_min, z_max  metres, optional: the zone of one floor of a building (PlannedZone)
// Portals: LineString features of two positions with properties
//   portal     true
//   zones      [A, B], the names of the two zones it joins
//   name       optional; else the feature's id, else "A-B"
// A file without portals gets one at every shared border that is at least kMinFoundPortal_m long.
// Other properties and other kinds of features are left alone; a feature that is not used
// gives a warning. Positions may have further numbers after x and y.
//
// A portal's ends may be up to the snap distance off the border that its zones share; they are
// moved to the nearest point of it. Where the two outlines do not coincide (up to twice the snap
// distance apart), the shared border runs midway between them.
namespace zonepack::packer {

inline constexpr double kDefaultSnap_m = 0.10;
inline constexpr double kMinFoundPortal_m = 0.30;
inline constexpr double kMaxOverlap = 0.01;  // of the smaller zone's area
inline constexpr double kMaxCoordinate_m = 1e6;
inline constexpr double kMinZoneArea_m2 = 1e-4;

struct ZoneFile {
  ZonePlan plan;  // after faults: what could be read
  Findings findings;
};

// Never throws because of the text: every error in it is a finding.
ZoneFile parse_zone_file(std::string_view text, double snap_m = kDefaultSnap_m);

// The same from a file; throws std::runtime_error when the file cannot be read.
ZoneFile check_zone_file(const std::string& path, double snap_m = kDefaultSnap_m);

// For packing: throws a std::runtime_error that lists every fault, so the findings are warnings
// only.
ZoneFile load_zone_file(const std::string& path, double snap_m = kDefaultSnap_m);

// The text of a zone file. Throws std::runtime_error naming the file when it cannot be read, or is
// something else.
std::string read_zone_text(const std::string& path);

// Why a name cannot name a zone or portal ("it is empty"); nothing when it can. Names become parts
// of file names and appear unescaped in event logs: 1 to 64 bytes of UTF-8 without control
// characters, / \ and ", not beginning or ending with a blank, and not beginning with a dot.
std::optional<std::string> find_name_problem(std::string_view name);

}  // namespace zonepack::packer
