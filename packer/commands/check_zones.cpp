// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/check_zones.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <memory>
#include <vector>

#include "packer/console/command_line.hpp"
#include "packer/sources/rtabmap_database.hpp"
#include "packer/zones/partition.hpp"
#include "platform/base/utf8.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kOrphansPrinted = 20;

struct SignatureCounts {
  Partition partition;
  std::size_t linked = 0, unlinked = 0;
};

SignatureCounts count_signatures(const std::filesystem::path& db, const ZonePlan& plan) {
  const RtabmapDatabase database(db);
  require_signatures(database.outline(), db.string());
  SignatureCounts counts;
  std::vector<SignaturePlace> places;
  for (const NodeOutline& node : database.outline().nodes) {
    if (!node.pose) continue;
    const Transform& T = *node.pose;
    places.push_back({node.id, {T[3], T[7]}, T[11]});
  }
  counts.linked = places.size();
  counts.unlinked = database.outline().nodes.size() - places.size();
  counts.partition = partition(plan.zones, places, OrphanPolicy::kDrop);
  return counts;
}

ordered_json to_json(const Finding& finding) {
  ordered_json json = {{"feature", nullptr}, {"line", nullptr}, {"name", finding.name}};
  if (finding.feature) json["feature"] = *finding.feature;
  if (finding.line != 0) json["line"] = finding.line;
  json["message"] = finding.message;
  return json;
}

ordered_json to_json(const FindingList& findings) {
  ordered_json list = ordered_json::array();
  for (const Finding& finding : findings) list.push_back(to_json(finding));
  if (findings.left_out() > 0) {
    list.push_back(to_json(
        Finding{std::nullopt, 0, "", "and " + std::to_string(findings.left_out()) + " more"}));
  }
  return list;
}

ordered_json to_json(const PlannedPortal& portal, const ZonePlan& plan) {
  const auto& [p, q] = portal.segment;
  return {{"name", portal.name},
          {"zones", {plan.zones[portal.zone_a].name, plan.zones[portal.zone_b].name}},
          {"line", {{p.x_m, p.y_m}, {q.x_m, q.y_m}}},
          {"length_m", distance_m(p, q)}};
}

ordered_json zones_json(const ZonePlan& plan, const std::optional<SignatureCounts>& counts) {
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  ordered_json zones = ordered_json::array();
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    const PlannedZone& zone = plan.zones[i];
    zones.push_back({{"name", zone.name},
                     {"zone_type", zone.zone_type},
                     {"label", zone.label},
                     {"area_m2", std::round(area_m2(zone.polygon) * 1e4) / 1e4},
                     {"portals", portals[i]}});
    if (counts) zones.back()["signatures"] = counts->partition.signatures[i];
  }
  return zones;
}

ordered_json signatures_json(const SignatureCounts& counts, const ZonePlan& plan) {
  ordered_json orphans = ordered_json::array();
  for (const Orphan& orphan : counts.partition.orphans) {
    orphans.push_back({{"id", orphan.id},
                       {"x", orphan.p_map.x_m},
                       {"y", orphan.p_map.y_m},
                       {"nearest_zone", plan.zones[orphan.nearest_zone].name},
                       {"distance_m", orphan.distance_m}});
  }
  return {{"in_zones", counts.linked - counts.partition.orphans.size()},
          {"on_border", counts.partition.on_border},
          {"unlinked", counts.unlinked},
          {"orphans", std::move(orphans)}};
}

std::string plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void print_zones(const ZonePlan& plan, const std::optional<SignatureCounts>& counts,
                 std::ostream& text) {
  std::size_t name_width = 4, type_width = 4;
  for (const PlannedZone& zone : plan.zones) {
    name_width = std::max(name_width, utf8_width(zone.name));
    type_width = std::max(type_width, utf8_width(zone.zone_type));
  }
  const auto padded = [](const std::string& cell, std::size_t width) {
    return cell + std::string(width - utf8_width(cell), ' ');
  };
  text << "\n"
       << padded("zone", name_width) << "  " << padded("type", type_width)
       << "     area m2  portals" << (counts ? "  signatures" : "") << "\n";
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    const PlannedZone& zone = plan.zones[i];
    text << padded(zone.name, name_width) << "  " << padded(zone.zone_type, type_width)
         << std::fixed << std::setprecision(1) << std::setw(12) << area_m2(zone.polygon)
         << std::setw(9) << portals[i];
    if (counts) text << std::setw(12) << counts->partition.signatures[i];
    text << "\n";
  }
}

void print_signatures(const SignatureCounts& counts, const ZonePlan& plan, std::ostream& text) {
  const std::vector<Orphan>& orphans = counts.partition.orphans;
  text << "\n"
       << plural(counts.linked - orphans.size(), "signature") << " in zones, " << orphans.size()
       << " in none\n";
  for (std::size_t i = 0; i < orphans.size() && i < kOrphansPrinted; ++i) {
    text << "  signature " << orphans[i].id << " at " << point_text(orphans[i].p_map) << ", "
         << number_text(orphans[i].distance_m) << " m from zone '"
         << plan.zones[orphans[i].nearest_zone].name << "'\n";
  }
  if (orphans.size() > kOrphansPrinted) {
    text << "  and " << orphans.size() - kOrphansPrinted << " more (--json lists all)\n";
  }
  if (!orphans.empty())
    text << "  build gives them to the nearest zone unless --orphans says otherwise\n";
  if (counts.unlinked > 0) {
    text << "warning: " << plural(counts.unlinked, "signature")
         << " without an optimised pose not counted; build places them as --unlinked says\n";
  }
}

void warn_of_empty_zones(const ZonePlan& plan, const SignatureCounts& counts, Findings& findings) {
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    if (counts.partition.signatures[i] > 0) continue;
    const std::string& name = plan.zones[i].name;
    findings.warnings.push_back(
        {std::nullopt, 0, name,
         "zone '" + name + "' holds no signature; was it drawn in the right place?"});
  }
}

}  // namespace

int check_zones(const CheckZonesOptions& options, std::ostream& text, ordered_json& json) {
  ZoneFile file = check_zone_file(options.zones, options.snap_m);
  const ZonePlan& plan = file.plan;
  Findings& findings = file.findings;
  std::optional<SignatureCounts> counts;
  if (options.db && !plan.zones.empty()) {
    counts = count_signatures(*options.db, plan);
    warn_of_empty_zones(plan, *counts, findings);
  }

  text << options.zones << ": " << plural(plan.zones.size(), "zone") << ", "
       << plural(plan.portals.size(), "portal")
       << (plan.portals_found ? " (none drawn: found from shared borders)" : "") << "; "
       << plural(findings.faults.size(), "fault") << ", "
       << plural(findings.warnings.size(), "warning") << "\n";
  for (const Finding& fault : findings.faults) {
    text << "fault: " << to_string(fault, options.zones) << "\n";
  }
  if (findings.faults.left_out() > 0) {
    text << "fault: and " << findings.faults.left_out() << " more\n";
  }
  for (const Finding& warning : findings.warnings) {
    text << "warning: " << to_string(warning, options.zones) << "\n";
  }
  if (findings.warnings.left_out() > 0) {
    text << "warning: and " << findings.warnings.left_out() << " more\n";
  }
  if (!plan.zones.empty()) print_zones(plan, counts, text);
  if (counts) print_signatures(*counts, plan, text);
  if (!findings.faults.empty()) {
    text << "\nMend the faults and check again; 'zonepack build' refuses this file.\n";
  }

  json["zones_file"] = options.zones;
  json["snap_m"] = options.snap_m;
  json["faults"] = to_json(findings.faults);
  json["warnings"] = to_json(findings.warnings);
  json["zones"] = zones_json(plan, counts);
  json["portals_found"] = plan.portals_found;
  json["portals"] = ordered_json::array();
  for (const PlannedPortal& portal : plan.portals) json["portals"].push_back(to_json(portal, plan));
  if (counts) json["signatures"] = signatures_json(*counts, plan);
  return findings.faults.empty() ? 0 : 1;
}

void add_check_zones_command(CLI::App& app, int& exit_code) {
  struct Arguments {
    CheckZonesOptions options;
    JsonOutput json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "check-zones", "Report every fault of a zone file at once, and the signatures per zone");
  command->add_option("ZONES", arguments->options.zones, "GeoJSON of zones and portals, in metres")
      ->required();
  command->add_option("--db", arguments->options.db, "RTAB-Map database: count signatures per zone")
      ->type_name("DB");
  command
      ->add_option("--snap", arguments->options.snap_m,
                   "how far a portal's ends may stand off the border, metres")
      ->type_name("METRES")
      ->check([](const std::string& metres) {  // also refuses "nan", which CLI::Range lets pass
        double value = 0;
        const bool fits = CLI::detail::lexical_cast(metres, value) && value >= 0 && value <= 10;
        return fits ? std::string() : "'" + metres + "' is no distance between 0 and 10 metres";
      })
      ->capture_default_str();
  arguments->json.add_option(*command);
  command->footer(
      "Zones are Polygon features with \"name\" and \"zone_type\"; portals are LineString features "
      "with\n"
      "\"portal\": true and \"zones\": [\"A\", \"B\"]. Without portals they are found from shared "
      "borders.\n"
      "Exit code: 0 no faults, 1 faults or a file that cannot be read, 2 wrong usage.");
  command->callback([arguments, &exit_code] {
    ordered_json json;
    exit_code = check_zones(arguments->options, arguments->json.text(), json);
    arguments->json.write(json);
  });
}

}  // namespace zonepack::packer
