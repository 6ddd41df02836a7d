// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "packer/zones/zone_file.hpp"

// Zone files as short texts, one feature a line, so that feature i stands on line i + 2.
namespace zonepack::packer {

inline std::string collection(const std::vector<std::string>& features) {
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [\n";
  for (std::size_t i = 0; i < features.size(); ++i) {
    text += features[i] + (i + 1 < features.size() ? ",\n" : "\n");
  }
  return text + "]}\n";
}

// `rings` is the inside of "coordinates".
inline std::string zone(const std::string& name, const std::string& rings,
                        const std::string& more_properties = "") {
  return R"({"type": "Feature", "properties": {"name": ")" + name + R"(", "zone_type": "room")" +
         more_properties + R"(}, "geometry": {"type": "Polygon", "coordinates": [)" + rings + "]}}";
}

// An upright rectangle.
inline std::string box(const std::string& name, double x0, double y0, double x1, double y1,
                       const std::string& more_properties = "") {
  const auto at = [](double x, double y) {
    return "[" + std::to_string(x) + "," + std::to_string(y) + "]";
  };
  return zone(name,
              "[" + at(x0, y0) + "," + at(x1, y0) + "," + at(x1, y1) + "," + at(x0, y1) + "," +
                  at(x0, y0) + "]",
              more_properties);
}

inline std::string portal(const std::string& name, const std::string& a, const std::string& b,
                          const std::string& line) {
  return R"({"type": "Feature", "properties": {"name": ")" + name +
         R"(", "portal": true, "zones": [")" + a + R"(", ")" + b +
         R"("]}, "geometry": {"type": "LineString", "coordinates": )" + line + "}}";
}

inline ZoneFile parse(const std::vector<std::string>& features, double snap_m = kDefaultSnap_m) {
  return parse_zone_file(collection(features), snap_m);
}

// Two rooms side by side, sharing x = 4, y 0...3, and the door between them.
inline const std::string kLeft = box("A", 0, 0, 4, 3);
inline const std::string kRight = box("B", 4, 0, 8, 3);
inline const std::string kDoor = portal("P1", "A", "B", "[[4,1],[4,2]]");

inline std::vector<std::string> messages(const FindingList& findings) {
  std::vector<std::string> texts;
  for (const Finding& finding : findings) texts.push_back(finding.message);
  return texts;
}

inline std::vector<std::string> faults_of(const std::vector<std::string>& features,
                                          double snap_m = kDefaultSnap_m) {
  return messages(parse(features, snap_m).findings.faults);
}

}  // namespace zonepack::packer
