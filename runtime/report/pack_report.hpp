// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/file/geometry.hpp"
#include "runtime/report/floor_plan.hpp"
#include "runtime/report/report.hpp"

// What a packed map holds, for drawing; the reader of the manifest fills it in.
namespace zonepack::report {

struct PackedZone {
  std::string name, zone_type, label;
  std::string layer;  // mapping pass; empty: none
  Polygon polygon;
  std::uint64_t signatures = 0;
  std::uint64_t features = 0;
  ByteCount charged_bytes = 0;  // while it is in memory: slots x slot size
  ByteCount stored_bytes = 0;   // read to load it
  std::vector<Point2> signature_positions;
};

struct PackReport {
  std::string map;      // as the user named it
  std::string version;  // names these very bytes
  std::string payload;  // what is loaded: "features, scan, grid"
  std::string source;   // its source and the program that packed it
  std::vector<PackedZone> zones;
  std::vector<Segment2> portals;
  std::optional<PlanRaster> ground;  // the occupancy grid, when it is known
  ByteCount table_bytes = 0;         // tables and read buffers, with every zone loaded
  ByteCount smallest_budget_bytes = 0;
  std::string smallest_budget_pair;  // "C3 with H1"
};

// One page: the floor plan with zones coloured by charged bytes, and the zones as a table.
Report make_pack_report(const PackReport& map);

}  // namespace zonepack::report
