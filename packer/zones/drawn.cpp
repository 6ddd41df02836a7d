// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/drawn.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "packer/zones/plane.hpp"
#include "packer/zones/zone_checks.hpp"
#include "packer/zones/zone_file.hpp"
#include "runtime/pack_format/file/zone_name.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::json;

// One feature being read: its properties, and the faults that name it.
class DrawnFeature {
 public:
  DrawnFeature(const GeoJsonFeature& feature, Findings& findings)
      : feature_(feature), findings_(findings) {
    if (const auto it = feature.value.find("properties");
        it != feature.value.end() && it->is_object()) {
      properties_ = *it;
    }
    if (const auto it = feature.value.find("geometry");
        it != feature.value.end() && it->is_object()) {
      geometry_ = *it;
    }
    take_only_part();
    subject_ = "feature " + std::to_string(feature.index);
  }

  void call_it(const std::string& kind, const std::string& name) {
    name_ = name;
    subject_ = kind + " '" + name + "' (feature " + std::to_string(feature_.index) + ")";
  }
  void call_it_nameless(const std::string& kind) {
    subject_ = kind + " without a name (feature " + std::to_string(feature_.index) + ")";
  }

  void fault(const std::string& message, FindingPlace place = {}) {
    findings_.faults.push_back(
        {feature_.index, feature_.line, name_, subject_ + " " + message, std::move(place)});
  }
  void warning(const std::string& message) {
    findings_.warnings.push_back({feature_.index, feature_.line, name_, subject_ + " " + message});
  }

  const json* property(const char* key) const {
    const auto it = properties_.find(key);
    return it == properties_.end() || it->is_null() ? nullptr : &*it;
  }
  std::string text(const char* key) {
    const json* value = property(key);
    if (value == nullptr) return "";
    if (value->is_string()) {
      const auto& given = value->get_ref<const std::string&>();
      // fit_name() judges names.
      if (key == std::string_view("name") || is_plain_text(given)) return given;
      fault(std::string("has a ") + key + " that holds a control character; remove it");
      return "";
    }
    if (value->is_number_integer()) return value->dump();
    fault(std::string("has a ") + key + " that is not text: " + value->dump() +
          "; write it in quotes");
    return "";
  }
  std::optional<double> number(const char* key) {
    const json* value = property(key);
    if (value == nullptr) return std::nullopt;
    if (value->is_number()) return value->get<double>();
    fault(std::string("has a ") + key + " that is not a number: " + value->dump() +
          "; expected metres");
    return std::nullopt;
  }

  std::string geometry_type() const {
    const auto it = geometry_.find("type");
    return it != geometry_.end() && it->is_string() ? it->get<std::string>() : "";
  }
  const json& coordinates() const {
    static const json kNone;
    const auto it = geometry_.find("coordinates");
    return it == geometry_.end() ? kNone : *it;
  }

  // A list of positions; `what` names it ("outline", "hole 1", "line").
  std::optional<Ring> positions(const json& list, const std::string& what) {
    if (!list.is_array()) {
      fault("has a broken " + what + ": expected a list of positions [x, y]");
      return std::nullopt;
    }
    Ring points;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const json& p = list[i];
      if (!p.is_array() || p.size() < 2 || !p[0].is_number() || !p[1].is_number()) {
        fault("has a broken " + what + ": position " + std::to_string(i) + " is " +
              p.dump().substr(0, 40) + ", expected [x, y] in metres");
        return std::nullopt;
      }
      const Point2 point{p[0].get<double>(), p[1].get<double>()};
      if (!(std::abs(point.x_m) <= kMaxCoordinate_m && std::abs(point.y_m) <= kMaxCoordinate_m)) {
        fault("has a " + what + " with position " + std::to_string(i) + " at " + p.dump() +
              ", beyond 1000 km: expected metres in the map frame, not longitude and latitude or "
              "another projection; move the drawing to the map's origin");
        return std::nullopt;
      }
      points.push_back(point);
    }
    return points;
  }

  // A closed list of positions, returned without the repeated last one and without doubled
  // vertices.
  std::optional<Ring> ring(const json& list, const std::string& what) {
    std::optional<Ring> points = positions(list, what);
    if (!points) return std::nullopt;
    if (points->size() > 1 && points->front() != points->back()) {
      fault("has an open " + what + ": it begins at " + point_text(points->front()) +
            " and ends at " + point_text(points->back()) +
            "; repeat the first position at the end");
      return std::nullopt;
    }
    Ring vertices;
    for (const Point2 p : *points) {
      if (vertices.empty() || distance_m(vertices.back(), p) > kBorderTolerance_m) {
        vertices.push_back(p);
      }
    }
    while (vertices.size() > 1 &&
           distance_m(vertices.front(), vertices.back()) <= kBorderTolerance_m) {
      vertices.pop_back();
    }
    if (vertices.size() < 3) {
      fault("has " + std::string(what == "outline" ? "an " : "a ") + what + " of " +
            std::to_string(vertices.size()) + (vertices.size() == 1 ? " vertex" : " vertices") +
            "; at least 3 are needed");
      return std::nullopt;
    }
    return vertices;
  }

 private:
  // QGIS saves every layer as Multi-geometries, mostly of one part.
  void take_only_part() {
    const std::string type = geometry_type();
    const auto at = geometry_.find("coordinates");
    if (!type.starts_with("Multi") || at == geometry_.end() || !at->is_array() || at->size() != 1) {
      return;
    }
    json only = std::move((*at)[0]);
    geometry_["coordinates"] = std::move(only);
    geometry_["type"] = type.substr(5);
  }

  const GeoJsonFeature& feature_;
  Findings& findings_;
  json properties_ = json::object();
  json geometry_ = json::object();
  std::string subject_;
  std::string name_;
};

// The name as given; reports a fault when it cannot be used.
std::string fit_name(DrawnFeature& reader, const std::string& kind, std::string name) {
  reader.call_it(kind, name);
  if (const auto problem = find_name_problem(name)) {
    reader.fault("has an unfit name: " + *problem);
  }
  return name;
}

void read_outline(DrawnFeature& reader, DrawnZone& drawn) {
  const json& rings = reader.coordinates();
  if (!rings.is_array() || rings.empty()) {
    reader.fault("has a Polygon without coordinates; draw its outline");
    return;
  }
  std::optional<Ring> outer = reader.ring(rings[0], "outline");
  if (!outer) return;
  Polygon polygon{std::move(*outer), {}};
  for (std::size_t i = 1; i < rings.size(); ++i) {
    std::optional<Ring> hole = reader.ring(rings[i], "hole " + std::to_string(i));
    if (!hole) return;
    polygon.holes.push_back(std::move(*hole));
  }
  const std::vector<OutlineFault> faults = outline_faults(polygon);
  for (const OutlineFault& fault : faults) reader.fault(fault.message, fault.place);
  drawn.sound = faults.empty();
  drawn.zone.polygon = with_interior_on_the_left(std::move(polygon));
}

void read_zone(const GeoJsonFeature& feature, DrawnFeature& reader, Drawing& drawing) {
  DrawnZone drawn{feature.index, feature.line, {}, false};
  PlannedZone& zone = drawn.zone;
  reader.call_it_nameless("zone");
  zone.name = reader.text("name");
  if (zone.name.empty()) {
    reader.fault("needs a property \"name\", such as \"R11\"");
  } else {
    zone.name = fit_name(reader, "zone", std::move(zone.name));
  }
  zone.zone_type = reader.text("zone_type");
  if (zone.zone_type.empty()) {
    reader.warning("has no zone_type; give it one, such as \"ward\" or \"corridor\"");
  }
  zone.label = reader.text("label");
  zone.layer = reader.text("layer");
  zone.floor = reader.text("floor");
  zone.z_min_m = reader.number("z_min");
  zone.z_max_m = reader.number("z_max");
  if (zone.z_min_m && zone.z_max_m && *zone.z_min_m >= *zone.z_max_m) {
    reader.fault("has z_min " + number_text(*zone.z_min_m) + ", not below its z_max " +
                 number_text(*zone.z_max_m));
  }
  read_outline(reader, drawn);
  drawing.zones.push_back(std::move(drawn));
}

// A portal without a name property takes the feature's id.
std::string portal_name_given(const GeoJsonFeature& feature, DrawnFeature& reader) {
  std::string name = reader.text("name");
  if (!name.empty()) return name;
  const auto id = feature.value.find("id");
  if (id == feature.value.end()) return "";
  if (id->is_string()) return id->get<std::string>();
  return id->is_number_integer() ? id->dump() : "";
}

void read_portal(const GeoJsonFeature& feature, DrawnFeature& reader, Drawing& drawing) {
  ++drawing.portal_features;
  DrawnPortal portal{feature.index, feature.line, portal_name_given(feature, reader), {}, {}};
  reader.call_it_nameless("portal");
  if (!portal.name.empty()) portal.name = fit_name(reader, "portal", std::move(portal.name));

  const json* zones = reader.property("zones");
  const bool linked = zones != nullptr && zones->is_array() && zones->size() == 2 &&
                      (*zones)[0].is_string() && (*zones)[1].is_string();
  if (linked) {
    portal.zones = {(*zones)[0].get<std::string>(), (*zones)[1].get<std::string>()};
  } else {
    reader.fault("needs a property \"zones\": [\"A\", \"B\"], the names of the two zones it joins");
  }
  const std::optional<Ring> points = reader.positions(reader.coordinates(), "line");
  if (!points) return;
  if (points->size() != 2) {
    reader.fault("has " + std::to_string(points->size()) +
                 " positions; a portal is one straight line of two positions");
    return;
  }
  portal.segment = {(*points)[0], (*points)[1]};
  if (distance_m(portal.segment.p, portal.segment.q) <= kBorderTolerance_m) {
    reader.fault("has no length: both ends are at " + point_text(portal.segment.p) +
                 "; draw it across the opening, along the border");
    return;
  }
  if (linked) drawing.portals.push_back(std::move(portal));
}

void read_line(const GeoJsonFeature& feature, DrawnFeature& reader, Drawing& drawing) {
  const json* portal = reader.property("portal");
  if (portal != nullptr && *portal == true) {
    read_portal(feature, reader, drawing);
  } else if (portal != nullptr && *portal != false) {
    reader.fault("has \"portal\": " + portal->dump() + "; expected true");
  } else if (reader.property("zones") != nullptr) {
    reader.fault("is a line with \"zones\" but without \"portal\": true; add it");
  } else {
    reader.warning("is a LineString without \"portal\": true; it is left out");
  }
}

std::string parts_text(const json& coordinates) {
  if (!coordinates.is_array() || coordinates.empty()) return "";
  return " of " + std::to_string(coordinates.size()) + " parts";
}

// The box around all positions of the file.
struct Extent {
  double x_min = HUGE_VAL, y_min = HUGE_VAL, x_max = -HUGE_VAL, y_max = -HUGE_VAL;

  void add(const json& coordinates) {
    if (!coordinates.is_array()) return;
    if (coordinates.size() >= 2 && coordinates[0].is_number() && coordinates[1].is_number()) {
      const auto x = coordinates[0].get<double>();
      const auto y = coordinates[1].get<double>();
      x_min = std::min(x_min, x);
      x_max = std::max(x_max, x);
      y_min = std::min(y_min, y);
      y_max = std::max(y_max, y);
      return;
    }
    for (const json& part : coordinates) add(part);
  }
};

std::string exact(double value) { return json(value).dump(); }

// A building in degrees is smaller than a tenth of one; in metres it would be 10 cm.
std::string looks_like_degrees(const std::vector<GeoJsonFeature>& features) {
  constexpr double kMost_deg = 0.1;
  constexpr double kEarth_m = 6378137;  // radius of EPSG:3857
  Extent all;
  for (const GeoJsonFeature& feature : features) {
    const auto geometry = feature.value.find("geometry");
    if (geometry == feature.value.end() || !geometry->is_object()) continue;
    if (const auto at = geometry->find("coordinates"); at != geometry->end()) all.add(*at);
  }
  const double width = all.x_max - all.x_min;
  const double height = all.y_max - all.y_min;
  const bool small = width >= 0 && width < kMost_deg && height >= 0 && height < kMost_deg;
  const bool on_earth = std::abs(all.x_min) <= 180 && std::abs(all.y_min) <= 85;
  if (!small || !on_earth || width + height <= 0) return "";
  const auto metres_text = [](double longitude, double latitude) {
    const double x = kEarth_m * longitude * M_PI / 180;
    const double y = kEarth_m * std::log(std::tan(M_PI / 4 + latitude * M_PI / 360));
    return "(" + number_text(std::round(x * 100) / 100) + ", " +
           number_text(std::round(y * 100) / 100) + ")";
  };
  return "all zones together lie between (" + exact(all.x_min) + ", " + exact(all.y_min) +
         ") and (" + exact(all.x_max) + ", " + exact(all.y_max) +
         "), less than 10 cm apart: the coordinates look like degrees of longitude and latitude, "
         "expected metres in the map frame. In EPSG:3857 they are " +
         metres_text(all.x_min, all.y_min) + " to " + metres_text(all.x_max, all.y_max) +
         ": save the zones in EPSG:3857 (QGIS: in the project's CRS, not in WGS 84)";
}

}  // namespace

Drawing read_drawing(const std::vector<GeoJsonFeature>& features, Findings& findings) {
  Drawing drawing;
  if (const std::string degrees = looks_like_degrees(features); !degrees.empty()) {
    findings.faults.push_back({std::nullopt, 0, "", degrees});
    return drawing;
  }
  for (const GeoJsonFeature& feature : features) {
    DrawnFeature reader(feature, findings);
    const std::string type = reader.geometry_type();
    if (type == "Polygon") {
      read_zone(feature, reader, drawing);
    } else if (type == "LineString") {
      read_line(feature, reader, drawing);
    } else if (type == "MultiPolygon" || type == "MultiLineString" ||
               type == "GeometryCollection") {
      if (const std::string name = reader.text("name"); !name.empty()) reader.call_it(type, name);
      reader.fault(
          "is a " + type + parts_text(reader.coordinates()) +
          "; a zone is one Polygon and a portal one LineString: split it into single parts "
          "(QGIS: Vector > Geometry Tools > Multipart to Singleparts) and give each its own "
          "name");
    } else if (type.empty()) {
      reader.fault("has no geometry; draw it or delete the feature");
    } else {
      reader.warning("is a " + type + "; it is left out");
    }
  }
  return drawing;
}

}  // namespace zonepack::packer
