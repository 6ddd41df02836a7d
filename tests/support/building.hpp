// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "runtime/odometry/pose.hpp"
#include "runtime/zones/zone_graph.hpp"

// The zones of a GeoJSON file and a robot's true path, for tests that drive through a building
// without packing it first.
namespace zonepack::testing_support {

struct Building {
  std::vector<GraphZone> zones;  // sorted by name
  std::vector<GraphPortal> portals;

  ZoneId id(const std::string& name) const {
    for (ZoneId zone = 0; zone < zones.size(); ++zone) {
      if (zones[zone].name == name) return zone;
    }
    return kNoZone;
  }
};

inline Building read_building(const std::string& path) {
  std::ifstream file(path);
  const auto json = nlohmann::json::parse(file);
  Building building;
  for (const auto& feature : json["features"]) {
    if (feature["geometry"]["type"] != "Polygon") continue;
    GraphZone zone{feature["properties"]["name"], {}};
    for (const auto& point : feature["geometry"]["coordinates"][0]) {
      zone.polygon.outer.push_back({point[0], point[1]});
    }
    zone.polygon.outer.pop_back();  // GeoJSON repeats the first vertex
    building.zones.push_back(std::move(zone));
  }
  std::sort(building.zones.begin(), building.zones.end(),
            [](const GraphZone& a, const GraphZone& b) { return a.name < b.name; });
  for (const auto& feature : json["features"]) {
    if (feature["geometry"]["type"] != "LineString") continue;
    const auto& ends = feature["geometry"]["coordinates"];
    const auto& zones = feature["properties"]["zones"];
    building.portals.push_back({building.id(zones[0]),
                                building.id(zones[1]),
                                {{ends[0][0], ends[0][1]}, {ends[1][0], ends[1][1]}}});
  }
  return building;
}

struct TrueSample {
  double t_s = 0;
  Pose2 pose;
  double speed_m_s = 0;
  double yaw_rate_rad_s = 0;
};

// Lines "t x y z qx qy qz qw v w" of a robot on a plane.
inline std::vector<TrueSample> read_true_path(const std::string& path) {
  std::ifstream file(path);
  std::vector<TrueSample> samples;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    double t, x, y, z, qx, qy, qz, qw, v, w;
    fields >> t >> x >> y >> z >> qx >> qy >> qz >> qw >> v >> w;
    samples.push_back({t, {x, y, 2 * std::atan2(qz, qw)}, v, w});
  }
  return samples;
}

}  // namespace zonepack::testing_support
