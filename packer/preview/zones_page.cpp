// SPDX-License-Identifier: Apache-2.0
#include "packer/preview/zones_page.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "packer/console/words.hpp"
#include "packer/preview/ground.hpp"
#include "packer/zones/orphans.hpp"
#include "platform/base/natural_order.hpp"
#include "runtime/report/floor_plan.hpp"
#include "runtime/report/format.hpp"

namespace zonepack::packer {
namespace {

using report::format_count;

constexpr std::size_t kMostListed = 200;  // findings of one kind, in the picture and its tables
constexpr double kCellWidth_em = 58;      // of a message on a sheet

std::string hint_of(const PlannedZone& zone) {
  std::string text = zone.name;
  if (!zone.zone_type.empty()) text += " (" + zone.zone_type + ")";
  if (!zone.label.empty()) text += ", " + zone.label;
  return text + ": " + report::format_fixed(area_m2(zone.polygon), 1) + " m\xC2\xB2";
}

// One pale colour for each zone_type.
std::map<std::string, report::Color> type_colors(const ZonePlan& plan) {
  std::map<std::string, report::Color> colors;
  for (const PlannedZone& zone : plan.zones) colors.try_emplace(zone.zone_type);
  std::size_t index = 0;
  for (auto& [type, color] : colors) color = mix(report::kWhite, report::hue(index++), 0.3);
  return colors;
}

report::FloorPlan plan_of(const ZonesOnMap& map) {
  const ZonePlan& zones = map.zones->plan;
  const std::map<std::string, report::Color> colors = type_colors(zones);
  report::FloorPlan plan;
  for (std::size_t i = 0; i < zones.zones.size(); ++i) {
    const PlannedZone& zone = zones.zones[i];
    std::string hint = hint_of(zone);
    if (i < map.partition.signatures.size()) {
      hint += ", " + counted(map.partition.signatures[i], "signature");
    }
    plan.zones.push_back({.name = zone.name,
                          .note = zone.zone_type,
                          .hint = std::move(hint),
                          .polygon = zone.polygon,
                          .fill = colors.at(zone.zone_type)});
  }
  for (const PlannedPortal& portal : zones.portals) plan.portals.push_back(portal.segment);
  for (std::size_t i = 0; i < map.places.size(); ++i) {
    const bool in_zone =
        i >= map.partition.zone_of.size() || map.partition.zone_of[i] != Partition::kNone;
    if (in_zone) plan.signatures.push_back(map.places[i].p_map);
  }
  for (const Orphan& orphan : map.partition.orphans) {
    plan.orphans.push_back({orphan.p_map, "signature " + std::to_string(orphan.id) + ", " +
                                              number_text(orphan.distance_m) + " m from " +
                                              zones.zones[orphan.nearest_zone].name});
  }
  std::size_t number = 0;
  for (const Finding& fault : map.zones->findings.faults) {
    if (++number > kMostListed) break;
    if (fault.place.empty()) continue;
    plan.faults.push_back({.number = std::to_string(number),
                           .hint = std::to_string(number) + ": " + fault.message,
                           .areas = fault.place.areas,
                           .lines = fault.place.lines,
                           .points = fault.place.points});
  }
  if (map.ground != nullptr) plan.raster = raster_of(*map.ground);
  return plan;
}

// One row or, wrapped, one for each line of the message.
void add_row(report::Table& table, std::vector<std::string> cells, bool wrap) {
  std::vector<std::string> lines{cells.back()};
  if (wrap) lines = report::wrap_text(cells.back(), kCellWidth_em);
  for (const std::string& line : lines) {
    cells.back() = line;
    table.rows.push_back(cells);
    for (std::string& cell : cells) cell.clear();
  }
}

report::Table findings_table(const std::string& title, const std::string& caption,
                             const FindingList& findings, bool wrap) {
  report::Table table{
      title, caption, {{"No.", true}, {"Line", true}, {"Name"}, {"What is wrong"}}, {}};
  std::size_t number = 0;
  for (const Finding& finding : findings) {
    if (++number > kMostListed) break;
    add_row(table,
            {std::to_string(number), finding.line == 0 ? "" : std::to_string(finding.line),
             finding.name, finding.message},
            wrap);
  }
  if (findings.size() > kMostListed) {
    table.rows.push_back(
        {"", "", "", "and " + std::to_string(findings.size() - kMostListed) + " more"});
  }
  return table;
}

report::Table orphans_table(const ZonesOnMap& map) {
  report::Table table{"Signatures in no zone",
                      "Red dots in the plan. A build gives them to the nearest zone unless "
                      "--orphans says otherwise; extend the zones where the robot drives.",
                      {{"Nearest zone"}, {"Signatures", true}, {"Where"}},
                      {}};
  for (const OrphanGroup& group : group_orphans(map.partition.orphans)) {
    table.rows.push_back({map.zones->plan.zones[group.nearest_zone].name, format_count(group.count),
                          near_text(group, map.zones->plan.zones)});
  }
  return table;
}

report::Table zones_table(const ZonesOnMap& map) {
  report::Table table{
      "Zones",
      "",
      {{"Zone"}, {"Type"}, {"Label"}, {"m\xC2\xB2", true}, {"Portals", true}, {"Signatures", true}},
      {}};
  const ZonePlan& plan = map.zones->plan;
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    const PlannedZone& zone = plan.zones[i];
    table.rows.push_back(
        {zone.name, zone.zone_type, zone.label, report::format_fixed(area_m2(zone.polygon), 1),
         format_count(portals[i]),
         i < map.partition.signatures.size() ? format_count(map.partition.signatures[i]) : ""});
  }
  std::ranges::sort(
      table.rows, [](const auto& a, const auto& b) { return natural_less(a.front(), b.front()); });
  return table;
}

std::string ground_text(const ZonesOnMap& map) {
  if (map.ground == nullptr) return "none (give --db or --grid)";
  if (map.ground->image.cells.empty()) return "none in the database";
  return std::filesystem::path(map.ground->source).filename().string();  // or "local grids"
}

std::vector<report::Fact> facts_of(const ZonesOnMap& map) {
  const Findings& findings = map.zones->findings;
  std::vector<report::Fact> facts{
      {"zones", format_count(map.zones->plan.zones.size()),
       counted(map.zones->plan.portals.size(), "portal")},
      {"faults", format_count(findings.faults.size()),
       findings.faults.empty() ? "zonepack build takes this file" : "zonepack build refuses it",
       !findings.faults.empty()},
      {"warnings", format_count(findings.warnings.size()), ""},
      {"occupancy grid", ground_text(map), map.ground == nullptr ? "" : map.ground->detail}};
  if (map.ground == nullptr || map.places.empty()) return facts;
  const std::size_t orphans = map.partition.orphans.size();
  facts.push_back({"in zones", format_count(map.partition.zone_of.size() - orphans),
                   "signatures with an optimised pose"});
  facts.push_back({"in no zone", format_count(orphans), "red dots", orphans > 0});
  return facts;
}

}  // namespace

report::Report make_zones_page(const ZonesOnMap& map) {
  const Findings& findings = map.zones->findings;
  report::Report page;
  page.title = "Zones " + map.file;
  page.headline = counted(map.zones->plan.zones.size(), "zone") + ", " +
                  counted(map.zones->plan.portals.size(), "portal") + "; " +
                  counted(findings.faults.size(), "fault") + ", " +
                  counted(findings.warnings.size(), "warning") + ".";
  if (!map.places.empty() && !map.zones->plan.zones.empty()) {
    page.headline += " Of " + counted(map.places.size(), "signature") + ", " +
                     orphans_text(group_orphans(map.partition.orphans), map.zones->plan.zones) +
                     ".";
  }
  if (map.misdrawn) {
    page.headline +=
        " " + misdrawn_text(*map.misdrawn, map.partition.orphans.size(), map.places.size()) + ".";
  }
  page.facts = facts_of(map);
  page.figures.push_back(
      {"Floor plan",
       "Zones are coloured by zone_type. Walls and furniture are what the mapping robot saw, the "
       "veil what "
       "it did not see. Dots are signatures, orange bars are portals. Red is what is wrong, "
       "numbered as in the table of faults.",
       draw_floor_plan(plan_of(map))});
  if (!findings.faults.empty()) {
    page.tables.push_back(findings_table("Faults", "Each must be mended before the file is packed.",
                                         findings.faults, map.wrap));
  }
  if (!findings.warnings.empty()) {
    page.tables.push_back(findings_table("Warnings", "The file can be packed, but look at these.",
                                         findings.warnings, map.wrap));
  }
  if (!map.partition.orphans.empty()) page.tables.push_back(orphans_table(map));
  page.tables.push_back(zones_table(map));
  page.origin =
      map.origin.empty() ? "Drawn by zonepack check-zones from " + map.file + "." : map.origin;
  return page;
}

}  // namespace zonepack::packer
