// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/suggest_zones.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "packer/build/map_builder.hpp"
#include "packer/commands/options.hpp"
#include "packer/commands/report.hpp"
#include "packer/commands/source_options.hpp"
#include "packer/commands/suggest_ground.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/words.hpp"
#include "packer/preview/zones_page.hpp"
#include "packer/suggest/suggest.hpp"
#include "packer/zones/orphans.hpp"
#include "packer/zones/zone_text.hpp"
#include "platform/base/failure.hpp"
#include "platform/base/shell_word.hpp"
#include "platform/command_line/command_line.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/report/format.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;

struct Rule {
  std::string name;  // basins, grid, path, count
  double size = 0;   // metres or signatures
};

// "grid:5m" and the like; nothing when it is none.
std::optional<Rule> rule_of(const std::string& method) {
  if (method == "basins") return Rule{"basins", 0};
  const std::size_t colon = method.find(':');
  if (colon == std::string::npos) return std::nullopt;
  Rule rule{method.substr(0, colon), 0};
  std::string size = method.substr(colon + 1);
  const bool metres = rule.name == "grid" || rule.name == "path";
  if (!metres && rule.name != "count") return std::nullopt;
  if (metres && size.ends_with('m')) size.pop_back();
  if (!CLI::detail::lexical_cast(size, rule.size)) return std::nullopt;
  if (!(rule.size >= (metres ? 0.5 : 1) && rule.size <= 1e6)) return std::nullopt;
  if (!metres && rule.size != std::floor(rule.size)) return std::nullopt;
  return rule;
}

std::string source_of(const SuggestZonesOptions& options) {
  return options.grid.empty() ? options.source->name() : options.grid;
}

void write_text(const std::string& path, const std::string& text) {
  if (const Result<void> written = write_file_atomically(path, text); !written) {
    throw std::runtime_error(cannot_write(path, written.error()).message);
  }
}

// Splits zones that charge too much as a build would, by building.
ZonePlan split_by_bytes(const SuggestZonesOptions& options, const std::string& zones,
                        std::size_t& split) {
  std::string pattern =
      (std::filesystem::temp_directory_path() / "zonepack-suggest-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error(pattern + ": cannot create a folder to measure zones in");
  }
  struct Remover {
    std::filesystem::path folder;
    ~Remover() {
      std::error_code ignored;
      std::filesystem::remove_all(folder, ignored);
    }
  } const remover{pattern};
  BuildOptions build;
  build.source = *options.source;
  build.zones = remover.folder / "zones.geojson";
  build.out = remover.folder / "map";
  build.max_zone_bytes = options.max_zone_bytes;
  build.payload = kDefaultPayload;
  write_text(build.zones.string(), zones);
  std::ostringstream quiet;
  Progress progress(quiet, false);
  BuildSummary summary = build_map(build, progress);
  split = summary.split.size();
  return std::move(summary.plan);
}

void draw(const SuggestZonesOptions& options, const SuggestGround& ground, const ZoneFile& file) {
  ZonesOnMap map{.file = options.out,
                 .zones = &file,
                 .places = ground.places,
                 .partition = {},
                 .misdrawn = {},
                 .ground = &ground.drawing,
                 .wrap = !options.preview.ends_with(".html"),
                 .origin = "Drawn by zonepack suggest-zones from " + source_of(options) + "."};
  if (!ground.places.empty()) {
    map.partition = partition(file.plan.zones, ground.places, OrphanPolicy::kDrop);
  }
  if (const auto written = report::write_report(options.preview, make_zones_page(map)); !written) {
    throw std::runtime_error(written.error().message);
  }
}

std::map<std::string, std::size_t> kinds_of(const ZonePlan& plan) {
  std::map<std::string, std::size_t> kinds;
  for (const PlannedZone& zone : plan.zones) ++kinds[zone.zone_type];
  return kinds;
}

ordered_json to_json(const ZonePlan& plan) {
  ordered_json zones = ordered_json::array();
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    zones.push_back({{"name", plan.zones[i].name},
                     {"zone_type", plan.zones[i].zone_type},
                     {"area_m2", std::round(area_m2(plan.zones[i].polygon) * 100) / 100},
                     {"portals", portals[i]}});
  }
  return zones;
}

ordered_json portals_json(const ZonePlan& plan) {
  ordered_json portals = ordered_json::array();
  for (const PlannedPortal& portal : plan.portals) {
    portals.push_back(
        {{"name", portal.name},
         {"zones", {plan.zones[portal.zone_a].name, plan.zones[portal.zone_b].name}},
         {"width_m", std::round(distance_m(portal.segment.p, portal.segment.q) * 100) / 100}});
  }
  return portals;
}

}  // namespace

void suggest_zones(const SuggestZonesOptions& options, std::ostream& text, ordered_json& json) {
  const Rule rule = rule_of(options.method).value();
  const SuggestGround ground = read_ground(options.source, options.grid);
  const suggest::GridPlace place = place_of(ground);
  suggest::FreeSpace space = free_space_of(ground.drawing.image);
  suggest::Options how;
  how.door_ratio = options.door_ratio;
  how.min_area_m2 = options.min_area_m2;
  how.max_length_m = options.max_length_m;
  how.square_m = rule.size;
  if (rule.name == "grid") how.method = suggest::Method::kGrid;
  if (rule.name == "path" || rule.name == "count") {
    how.method = suggest::Method::kPath;
    how.path =
        path_of(ground, space, place,
                {rule.name == "path" ? PathRule::kMetres : PathRule::kSignatures, rule.size});
  }
  const std::string source = source_of(options);
  suggest::Suggestion found;
  try {
    found = suggest::suggest(std::move(space), place, how);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(source + ": " + error.what());
  }
  std::string zones = zones_geojson(found.plan);
  std::size_t split = 0;
  if (options.max_zone_bytes > 0) {
    found.plan = split_by_bytes(options, zones, split);
    zones = zones_geojson(found.plan);
  }
  const ZoneFile checked = parse_zone_file(zones);
  if (!checked.findings.faults.empty()) {
    throw std::runtime_error(source +
                             ": the suggested zones are faulty, which is a bug; please "
                             "report it with the grid\n" +
                             describe_faults(checked.findings, options.out));
  }
  write_text(options.out, zones);
  if (!options.preview.empty()) draw(options, ground, checked);

  text << options.out << ": " << counted(found.plan.zones.size(), "zone") << " (";
  const char* separator = "";
  for (const auto& [kind, count] : kinds_of(found.plan)) {
    text << separator << counted(count, kind, kind == "lobby" ? "lobbies" : kind + "s");
    separator = ", ";
  }
  text << ") and " << counted(found.plan.portals.size(), "portal") << " from "
       << ground.drawing.origin() << "\n";
  if (split > 0) {
    text << counted(split, "zone was", "zones were") << " split to keep to "
         << size_text(options.max_zone_bytes) << "\n";
  }
  std::vector<std::string> warnings = ground.drawing.warnings;
  for (const Finding& finding : checked.findings.warnings) warnings.push_back(finding.message);
  std::size_t orphans = 0;
  if (!ground.places.empty()) {
    orphans = count_outside(checked.plan.zones, ground.places);
    if (orphans > 0) {
      warnings.push_back(counted(orphans, "signature stands", "signatures stand") +
                         " in no zone; build gives them to the nearest");
    }
  }
  for (const std::string& warning : warnings) text << "warning: " << warning << "\n";
  if (!options.preview.empty()) text << options.preview << ": the zones as a picture\n";
  text << "Next: look at them, rename what you know by name, then\n  zonepack "
       << (options.source ? "build --db " + shell_word(options.source->name()) + " --zones " +
                                shell_word(options.out) + " --out map"
                          : "check-zones " + shell_word(options.out))
       << "\n";

  json["out"] = options.out;
  json["source"] = source;
  json["method"] = options.method;
  json["zones"] = to_json(found.plan);
  json["portals"] = portals_json(found.plan);
  json["apart"] = found.apart;
  json["free_cells_in_no_zone"] = found.dropped_cells;
  json["orphans"] = orphans;
  if (!options.preview.empty()) json["picture"] = options.preview;
  json["warnings"] = warnings;
}

void add_suggest_zones_command(CLI::App& app, int& exit_code) {
  struct Arguments {
    SuggestZonesOptions options;
    SourceOptions source;
    JsonOutput json;
  };
  const auto arguments = std::make_shared<Arguments>();
  SuggestZonesOptions& options = arguments->options;
  CLI::App* const command = app.add_subcommand(
      "suggest-zones", "Draw zones by themselves: rooms, corridors and doors of a floor plan");
  add_source_options(*command, arguments->source,
                     "draw on the map's own grid, its local grids, or a slice of its points or "
                     "voxels at a robot's height");
  add_slice_option(*command, arguments->source);
  command
      ->add_option("--grid", options.grid,
                   "draw on this grid of map_server (PGM or PNG); with --db, in the same frame")
      ->type_name("map.yaml");
  command->add_option("--out", options.out, "GeoJSON of zones and portals")
      ->type_name("zones.geojson")
      ->required();
  const auto within = [](double least, double most, const char* unit) {
    return [=](const std::string& word) {
      double value = 0;
      const bool fits = CLI::detail::lexical_cast(word, value) && value >= least && value <= most;
      return fits ? std::string()
                  : "'" + word + "' is no number from " + report::format_fixed(least, 1) + " to " +
                        report::format_fixed(most, 0) + unit;
    };
  };
  command
      ->add_option("--door-ratio", options.door_ratio,
                   "a pass narrower than this part of the narrower room's width is a door")
      ->type_name("RATIO")
      ->check(within(0.1, 1, ""))
      ->capture_default_str();
  command
      ->add_option("--min-area", options.min_area_m2,
                   "smaller regions join the neighbour with the widest pass, square metres")
      ->type_name("M2")
      ->check(within(0, 1000, " square metres"))
      ->capture_default_str();
  command
      ->add_option("--max-length", options.max_length_m,
                   "cut longer corridors and rooms across, metres along the way; default: none")
      ->type_name("METRES")
      ->check(within(1, 10000, " metres"));
  add_size_option(*command, "--max-zone-bytes", options.max_zone_bytes,
                  "with --db: split zones that would charge more, as build does");
  command
      ->add_option("--method", options.method,
                   "basins (default), or to compare: grid:5m squares, path:10m metres along the "
                   "mapping robot's path, count:50 signatures along it")
      ->type_name("METHOD")
      ->check([](const std::string& method) {
        return rule_of(method) ? std::string()
                               : "'" + method +
                                     "' is none of basins, grid:METRES, path:METRES, count:N (from "
                                     "0.5 m and 1 signature on)";
      });
  add_report_option(*command, options.preview, "draw the zones over the grid: .html, .svg or .png",
                    "--preview");
  arguments->json.add_option(*command);
  command->footer(
      "Rooms are where the clearance to walls rises; a door is where it falls between two of "
      "them.\n"
      "The zones share their borders, hold every free cell of their rooms, and are ready for\n"
      "build; portals stand in the doors. The same grid gives the same bytes on every machine.");
  add_examples(
      *command,
      {"zonepack suggest-zones --db map.db --out rooms.geojson --preview rooms.html",
       "zonepack suggest-zones --grid outline/map.yaml --out rooms.geojson --max-length 20"});
  command->callback([arguments, &exit_code] {
    SuggestZonesOptions& chosen = arguments->options;
    if (!arguments->source.path.empty()) chosen.source = arguments->source;
    if (!chosen.source && chosen.grid.empty()) {
      throw CLI::ValidationError("suggest-zones", "needs a floor plan: give --db or --grid");
    }
    const std::string rule = rule_of(chosen.method).value().name;
    if (!chosen.source && (rule == "path" || rule == "count")) {
      throw CLI::ValidationError(
          "--method", "'" + chosen.method + "' follows the mapping robot's path: give --db");
    }
    if (!chosen.source && chosen.max_zone_bytes > 0) {
      throw CLI::ValidationError("--max-zone-bytes", "needs the signatures of a map: give --db");
    }
    require_writable(chosen.out);
    require_writable(chosen.preview);
    arguments->json.require_writable();
    ordered_json json;
    suggest_zones(chosen, arguments->json.text(), json);
    arguments->json.write(json);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
