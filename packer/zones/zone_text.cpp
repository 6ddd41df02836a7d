// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_text.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;

double rounded_to(double value, double per_metre) {
  const double result = std::floor(value * per_metre + 0.5) / per_metre;
  return result == 0 ? 0 : result;  // no -0
}

ordered_json position(Point2 point) {
  return {rounded_to(point.x_m, 1e4), rounded_to(point.y_m, 1e4)};
}

ordered_json closed(const Ring& ring) {
  ordered_json positions = ordered_json::array();
  for (const Point2 point : ring) positions.push_back(position(point));
  positions.push_back(position(ring.front()));
  return positions;
}

ordered_json feature(const PlannedZone& zone) {
  ordered_json properties{{"name", zone.name}, {"zone_type", zone.zone_type}};
  for (const auto& [key, text] : {std::pair{"label", &zone.label}, std::pair{"layer", &zone.layer},
                                  std::pair{"floor", &zone.floor}}) {
    if (!text->empty()) properties[key] = *text;
  }
  if (zone.z_min_m) properties["z_min"] = *zone.z_min_m;
  if (zone.z_max_m) properties["z_max"] = *zone.z_max_m;
  properties["area_m2"] = rounded_to(area_m2(zone.polygon), 100);
  ordered_json rings = ordered_json::array({closed(zone.polygon.outer)});
  for (const Ring& hole : zone.polygon.holes) rings.push_back(closed(hole));
  return {{"type", "Feature"},
          {"properties", std::move(properties)},
          {"geometry", {{"type", "Polygon"}, {"coordinates", std::move(rings)}}}};
}

ordered_json feature(const PlannedPortal& portal, const ZonePlan& plan) {
  const auto& [p, q] = portal.segment;
  return {
      {"type", "Feature"},
      {"properties",
       {{"name", portal.name},
        {"portal", true},
        {"zones", {plan.zones[portal.zone_a].name, plan.zones[portal.zone_b].name}},
        {"width_m", rounded_to(distance_m(p, q), 100)}}},
      {"geometry",
       {{"type", "LineString"}, {"coordinates", ordered_json::array({position(p), position(q)})}}}};
}

}  // namespace

std::string zones_geojson(const ZonePlan& plan) {
  std::string text =
      "{\"type\": \"FeatureCollection\",\n"
      " \"crs\": {\"type\": \"name\", \"properties\": {\"name\": "
      "\"urn:ogc:def:crs:EPSG::3857\"}},\n"
      " \"features\": [";
  const char* separator = "\n";
  for (const PlannedZone& zone : plan.zones) {
    text += separator + feature(zone).dump();
    separator = ",\n";
  }
  for (const PlannedPortal& portal : plan.portals) {
    text += separator + feature(portal, plan).dump();
    separator = ",\n";
  }
  return text + "\n]}\n";
}

}  // namespace zonepack::packer
