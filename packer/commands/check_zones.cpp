// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/check_zones.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/commands/report.hpp"
#include "packer/commands/source_options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/text_table.hpp"
#include "packer/console/words.hpp"
#include "packer/outline/map_drawing.hpp"
#include "packer/outline/map_server.hpp"
#include "packer/preview/zones_page.hpp"
#include "packer/sources/open_source.hpp"
#include "packer/zones/orphans.hpp"
#include "packer/zones/partition.hpp"
#include "platform/command_line/command_line.hpp"
#include "runtime/report/format.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kGroupsPrinted = 20;

struct SignatureCounts {
  Partition partition;
  std::vector<SignaturePlace> places;  // of the linked ones
  std::size_t unlinked = 0;
  std::optional<Misdrawn> misdrawn;
};

SignatureCounts count_signatures(const MapOutline& outline, const ZonePlan& plan) {
  SignatureCounts counts;
  for (const NodeOutline& node : outline.nodes) {
    if (!node.pose) continue;
    const Transform& T = *node.pose;
    counts.places.push_back({node.id, {T[3], T[7]}, T[11]});
  }
  counts.unlinked = outline.nodes.size() - counts.places.size();
  if (plan.zones.empty()) return counts;
  counts.partition = partition(plan.zones, counts.places, OrphanPolicy::kDrop);
  counts.misdrawn = find_misdrawn(plan.zones, counts.places, counts.partition.orphans.size());
  return counts;
}

// What --db and --grid add.
struct Source {
  std::optional<SignatureCounts> counts;
  MapDrawing ground;  // only when a picture is wanted
};

Source read_source(const CheckZonesOptions& options, const ZonePlan& plan) {
  Source source;
  if (!options.grid.empty()) source.ground = drawing_of(read_grid_file(options.grid));
  if (!options.source) return source;
  const std::unique_ptr<MapSource> map = open_source(*options.source);
  require_signatures(map->outline(), options.source->name());
  source.counts = count_signatures(map->outline(), plan);
  if (options.out.empty() || !options.grid.empty()) return source;
  try {
    source.ground = drawing_of(*map, options.source->slice);
    source.ground.warn_if_missing(options.source->name());
  } catch (const std::runtime_error& error) {
    source.ground.warnings.push_back(options.source->name() + ": " + error.what() +
                                     "; no occupancy grid is drawn");
  }
  map->require_unchanged();
  return source;
}

ordered_json to_json(const Finding& finding) {
  ordered_json json = {{"feature", nullptr}, {"line", nullptr}, {"name", finding.name}};
  if (finding.feature) json["feature"] = *finding.feature;
  if (finding.line != 0) json["line"] = finding.line;
  json["message"] = finding.message;
  json["at"] = nullptr;
  if (const auto at = point_of(finding.place)) json["at"] = {at->x_m, at->y_m};
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

ordered_json zones_json(const ZonePlan& plan, const SignatureCounts* counts) {
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  ordered_json zones = ordered_json::array();
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    const PlannedZone& zone = plan.zones[i];
    zones.push_back({{"name", zone.name},
                     {"zone_type", zone.zone_type},
                     {"label", zone.label},
                     {"area_m2", std::round(area_m2(zone.polygon) * 1e4) / 1e4},
                     {"portals", portals[i]}});
    if (counts != nullptr) zones.back()["signatures"] = counts->partition.signatures[i];
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
  ordered_json json = {{"in_zones", counts.places.size() - counts.partition.orphans.size()},
                       {"on_border", counts.partition.on_border},
                       {"unlinked", counts.unlinked},
                       {"orphans", std::move(orphans)},
                       {"read_otherwise", nullptr}};
  if (counts.misdrawn) {
    json["read_otherwise"] = {{"how", counts.misdrawn->how}, {"orphans", counts.misdrawn->orphans}};
  }
  return json;
}

void print_zones(const ZonePlan& plan, const SignatureCounts* counts, std::ostream& text) {
  std::vector<std::string> head{"zone", "type", "area m2", "portals"};
  if (counts != nullptr) head.emplace_back("signatures");
  TextTable table(head);
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  std::vector<std::string> names;
  for (const PlannedZone& zone : plan.zones) names.push_back(zone.name);
  for (const std::size_t i : natural_order(names)) {
    const PlannedZone& zone = plan.zones[i];
    std::vector<std::string> row{zone.name, zone.zone_type,
                                 report::format_fixed(area_m2(zone.polygon), 1),
                                 std::to_string(portals[i])};
    if (counts != nullptr) row.push_back(std::to_string(counts->partition.signatures[i]));
    table.add(std::move(row));
  }
  text << "\n";
  table.print(text);
}

void print_signatures(const SignatureCounts& counts, const ZonePlan& plan, bool faulty,
                      std::ostream& text) {
  const std::vector<Orphan>& orphans = counts.partition.orphans;
  const std::vector<OrphanGroup> groups = group_orphans(orphans);
  text << "\n"
       << counted(counts.places.size() - orphans.size(), "signature") << " in zones, "
       << orphans_text(groups, plan.zones) << "\n";
  for (std::size_t i = 1; i < groups.size() && i <= kGroupsPrinted; ++i) {
    text << "  " << groups[i].count << " " << near_text(groups[i], plan.zones)
         << ", such as signature " << groups[i].example << "\n";
  }
  if (groups.size() > kGroupsPrinted + 1) {
    text << "  and others near " << counted(groups.size() - kGroupsPrinted - 1, "more zone")
         << " (--json lists every signature)\n";
  }
  if (!orphans.empty() && faulty) {
    text << "  zones with a faulty outline hold no signatures until they are mended\n";
  }
  if (!orphans.empty())
    text << "  build gives them to the nearest zone unless --orphans says otherwise\n";
  if (counts.unlinked > 0) {
    text << "warning: " << counted(counts.unlinked, "signature")
         << " without an optimised pose not counted; build places them as --unlinked says\n";
  }
}

void warn_of_empty_zones(const ZonePlan& plan, const SignatureCounts& counts, Findings& findings) {
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    if (counts.partition.signatures[i] > 0) continue;
    const std::string& name = plan.zones[i].name;
    findings.warnings.push_back(
        {std::nullopt,
         0,
         name,
         "zone '" + name + "' holds no signature; was it drawn in the right place?",
         {{plan.zones[i].polygon.outer}, {}, {}}});
  }
}

void print_findings(const FindingList& findings, const char* kind, const std::string& file,
                    std::ostream& text) {
  if (findings.empty()) return;
  text << "\n";
  for (const Finding& finding : findings) text << kind << to_string(finding, file) << "\n";
  if (findings.left_out() > 0) text << kind << "and " << findings.left_out() << " more\n";
}

void draw(const CheckZonesOptions& options, const ZoneFile& file, const Source* source) {
  ZonesOnMap map{.file = options.zones,
                 .zones = &file,
                 .places = {},
                 .partition = {},
                 .misdrawn = {},
                 .ground = nullptr,
                 .wrap = !options.out.ends_with(".html"),
                 .origin = {}};
  if (source != nullptr) map.ground = &source->ground;
  if (source != nullptr && source->counts) {
    map.places = source->counts->places;
    map.partition = source->counts->partition;
    map.misdrawn = source->counts->misdrawn;
  }
  if (const auto written = report::write_report(options.out, make_zones_page(map)); !written) {
    throw std::runtime_error(written.error().message);
  }
}

}  // namespace

int check_zones(const CheckZonesOptions& options, std::ostream& text, ordered_json& json) {
  ZoneFile file = check_zone_file(options.zones, options.snap_m);
  const ZonePlan& plan = file.plan;
  Findings& findings = file.findings;
  std::optional<Source> source;
  const bool wanted = options.source && (!plan.zones.empty() || !options.out.empty());
  if (wanted || !options.grid.empty()) {
    source = read_source(options, plan);
  }
  const SignatureCounts* const counts =
      source && source->counts && !plan.zones.empty() ? &*source->counts : nullptr;
  if (counts != nullptr) {
    warn_of_empty_zones(plan, *counts, findings);
    if (counts->misdrawn) {
      findings.warnings.push_back(
          {std::nullopt, 0, "",
           misdrawn_text(*counts->misdrawn, counts->partition.orphans.size(),
                         counts->places.size())});
    }
  }
  if (!options.out.empty()) draw(options, file, source ? &*source : nullptr);

  text << options.zones << ": " << counted(plan.zones.size(), "zone") << ", "
       << counted(plan.portals.size(), "portal")
       << (plan.portals_found ? " (none drawn: found from shared borders)" : "") << "; "
       << counted(findings.faults.size(), "fault") << ", "
       << counted(findings.warnings.size(), "warning") << "\n";
  if (!plan.zones.empty()) print_zones(plan, counts, text);
  if (counts != nullptr) print_signatures(*counts, plan, !findings.faults.empty(), text);
  if (!options.out.empty()) text << "\n" << options.out << ": the zones as a picture\n";
  if (source) {
    for (const std::string& warning : source->ground.warnings) {
      text << "warning: " << warning << "\n";
    }
  }
  print_findings(findings.warnings, "warning: ", options.zones, text);
  print_findings(findings.faults, "fault: ", options.zones, text);
  if (!findings.faults.empty()) {
    text << "\nMend the " << (findings.faults.size() == 1 ? "fault" : "faults")
         << " and check again; 'zonepack build' refuses this file.\n";
  }

  json["zones_file"] = options.zones;
  json["snap_m"] = options.snap_m;
  json["faults"] = to_json(findings.faults);
  json["warnings"] = to_json(findings.warnings);
  json["zones"] = zones_json(plan, counts);
  json["portals_found"] = plan.portals_found;
  json["portals"] = ordered_json::array();
  for (const PlannedPortal& portal : plan.portals) json["portals"].push_back(to_json(portal, plan));
  if (counts != nullptr) json["signatures"] = signatures_json(*counts, plan);
  if (!options.out.empty()) json["picture"] = options.out;
  return findings.faults.empty() ? 0 : 1;
}

void add_check_zones_command(CLI::App& app, int& exit_code) {
  struct Arguments {
    CheckZonesOptions options;
    SourceOptions source;
    JsonOutput json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "check-zones", "Report every fault of a zone file at once, and the signatures per zone");
  command->add_option("ZONES", arguments->options.zones, "GeoJSON of zones and portals, in metres")
      ->required();
  add_source_options(*command, arguments->source, "count the signatures of this map per zone");
  add_slice_option(*command, arguments->source);
  CLI::Option* const grid =
      command
          ->add_option("--grid", arguments->options.grid,
                       "draw the zones over this grid of map_server (PGM or PNG), in their frame")
          ->type_name("map.yaml");
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
  grid->needs(add_report_option(
      *command, arguments->options.out,
      "draw the zones over the database's occupancy grid, faults and signatures in no "
      "zone in red: .html, .svg or .png"));
  arguments->json.add_option(*command);
  command->footer(
      "Zones are Polygon features with \"name\" and \"zone_type\"; portals are LineString features "
      "with\n"
      "\"portal\": true and \"zones\": [\"A\", \"B\"]. Without portals they are found from shared "
      "borders.\n"
      "Exit code: 0 no faults, 1 faults or a file that cannot be read, 2 wrong usage.");
  add_examples(*command,
               {"zonepack check-zones zones.geojson",
                "zonepack check-zones zones.geojson --db map.db --out preview.html",
                "zonepack check-zones zones.geojson --grid outline/map.yaml --out preview.html",
                "zonepack check-zones zones.geojson --db map.db --snap 0.2 --json -"});
  command->callback([arguments, &exit_code] {
    if (!arguments->source.path.empty()) arguments->options.source = arguments->source;
    require_writable(arguments->options.out);
    arguments->json.require_writable();
    ordered_json json;
    exit_code = check_zones(arguments->options, arguments->json.text(), json);
    arguments->json.write(json);
  });
}

}  // namespace zonepack::packer
