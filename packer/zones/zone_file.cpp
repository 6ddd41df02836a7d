// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/zone_file.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "packer/zones/drawn.hpp"
#include "packer/zones/geojson.hpp"
#include "packer/zones/portals.hpp"
#include "packer/zones/zone_checks.hpp"
#include "platform/base/file_kind.hpp"
#include "platform/base/utf8.hpp"
#include "runtime/pack_format/file/zone_name.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

void add_sound_zones(const Drawing& drawing, ZonePlan& plan) {
  std::set<std::string> names;
  for (const DrawnZone& drawn : drawing.zones) {
    if (drawn.sound && !drawn.zone.name.empty() && names.insert(drawn.zone.name).second) {
      plan.zones.push_back(drawn.zone);
    }
  }
  sort_by_name(plan);
}

void warn_of_unreachable(const ZonePlan& plan, const Drawing& drawing, Findings& findings) {
  for (const std::uint32_t zone : unreachable_zones(plan)) {
    const std::string& name = plan.zones[zone].name;
    Finding warning{
        std::nullopt, 0, name,
        "zone '" + name +
            "' is unreachable: no portals join it to the other zones; draw a portal, or "
            "let its border meet its neighbour's"};
    for (const DrawnZone& drawn : drawing.zones) {
      if (drawn.zone.name != name) continue;
      warning.feature = drawn.feature;
      warning.line = drawn.line;
      break;
    }
    findings.warnings.push_back(std::move(warning));
  }
}

// Findings about a feature, or about a zone by name, are where it was drawn.
void locate(const Drawing& drawing, Findings& findings) {
  std::map<std::size_t, FindingPlace> by_feature;
  std::map<std::string, FindingPlace> by_name;
  for (const DrawnZone& drawn : drawing.zones) {
    if (drawn.zone.polygon.outer.empty()) continue;
    const FindingPlace place{{drawn.zone.polygon.outer}, {}, {}};
    by_feature.emplace(drawn.feature, place);
    by_name.emplace(drawn.zone.name, place);
  }
  for (const DrawnPortal& drawn : drawing.portals) {
    by_feature.emplace(drawn.feature, FindingPlace{{}, {drawn.segment}, {}});
  }
  const auto place_of = [&](const Finding& finding) {
    if (finding.feature) {
      const auto found = by_feature.find(*finding.feature);
      return found == by_feature.end() ? FindingPlace{} : found->second;
    }
    const auto found = by_name.find(finding.name);
    return finding.name.empty() || found == by_name.end() ? FindingPlace{} : found->second;
  };
  findings.faults.locate(place_of);
  findings.warnings.locate(place_of);
}

void check_portal_counts(const ZonePlan& plan, Findings& findings) {
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  for (std::size_t i = 0; i < portals.size(); ++i) {
    if (portals[i] <= kMaxPortalsPerZone) continue;
    const std::string& name = plan.zones[i].name;
    findings.faults.push_back({std::nullopt, 0, name,
                               "zone '" + name + "' has " + std::to_string(portals[i]) +
                                   " portals, at most " + std::to_string(kMaxPortalsPerZone) +
                                   " are allowed; divide it into several zones"});
  }
}

}  // namespace

std::string read_zone_text(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw std::runtime_error(path + ": cannot read the zone file: " + std::strerror(ENOENT) +
                             "; expected GeoJSON");
  }
  if (fs::is_directory(status)) {
    throw std::runtime_error(path + ": is a folder, expected a GeoJSON file with the zones");
  }
  std::ifstream file(path, std::ios::binary);
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > kMaxZoneFileBytes) {
    if (const std::string kind = misplaced_at(path, ""); !kind.empty()) {
      throw std::runtime_error(path + ": " + kind + ", not a zone file; expected GeoJSON");
    }
    throw std::runtime_error(path + ": is " + std::to_string(size) +
                             " bytes long, a zone file has at most " +
                             std::to_string(kMaxZoneFileBytes) +
                             "; simplify the outlines (QGIS: Vector > Geometry Tools > Simplify)");
  }
  if (!error && size == 0) {
    throw std::runtime_error(
        path + ": cannot read the zone file: it is empty (0 bytes); expected GeoJSON");
  }
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || !text) {
    throw std::runtime_error(path + ": cannot read the zone file: " +
                             (errno != 0 ? std::strerror(errno) : "it is empty") +
                             "; expected GeoJSON");
  }
  std::string bytes = std::move(text).str();
  if (const std::string kind = stand_in(bytes, path); !kind.empty()) {
    throw std::runtime_error(path + ": is " + kind + "; expected GeoJSON");
  }
  if (const std::string kind = known_kind(bytes, path); !kind.empty()) {
    throw std::runtime_error(path + ": is " + kind + ", not a zone file; expected GeoJSON");
  }
  return bytes;
}

ZoneFile parse_zone_file(std::string_view text, double snap_m) {
  ZoneFile result;
  ZonePlan& plan = result.plan;
  Findings& findings = result.findings;
  const Drawing drawing = read_drawing(read_features(text, findings), findings);
  if (drawing.zones.empty() && findings.faults.empty()) {
    findings.faults.push_back(
        {std::nullopt, 0, "", "no zones: expected at least one Polygon feature with a name"});
  }
  check_zones_together(drawing, findings);
  add_sound_zones(drawing, plan);
  if (drawing.portal_features > 0) {
    place_portals(drawing, snap_m, plan, findings);
  } else {
    find_portals(snap_m, plan, findings);
  }
  sort_by_name(plan);
  check_portal_counts(plan, findings);
  if (findings.faults.empty()) warn_of_unreachable(plan, drawing, findings);
  locate(drawing, findings);
  return result;
}

ZoneFile check_zone_file(const std::string& path, double snap_m) {
  return parse_zone_file(read_zone_text(path), snap_m);
}

ZoneFile load_zone_file(const std::string& path, double snap_m) {
  ZoneFile file = check_zone_file(path, snap_m);
  if (!file.findings.faults.empty()) {
    throw std::runtime_error(describe_faults(file.findings, path));
  }
  return file;
}

std::optional<std::string> find_name_problem(std::string_view name) {
  const auto fault = name_fault(name);
  if (!fault) return std::nullopt;
  switch (*fault) {
    case NameFault::kEmpty:
      return "it is empty";
    case NameFault::kTooLong:
      return "it is " + std::to_string(name.size()) + " bytes long, at most " +
             std::to_string(kMaxNameBytes) + " are allowed";
    case NameFault::kDot:
      return "it begins with a dot";
    case NameFault::kBlank:
      return "it begins or ends with a blank";
    case NameFault::kSeparator:
      return std::string("it holds ") + name[name.find_first_of("/\\\"")] +
             ", which file names and event logs cannot carry";
    case NameFault::kNotPlain:
      return is_utf8(name) ? "it holds a control character" : "it is not UTF-8";
  }
  return std::nullopt;
}

}  // namespace zonepack::packer
