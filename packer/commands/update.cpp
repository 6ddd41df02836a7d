// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/update.hpp"

#include <unistd.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/commands/session_options.hpp"
#include "packer/commands/source_options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/words.hpp"
#include "packer/update/map_update.hpp"
#include "packer/zones/findings.hpp"
#include "platform/command_line/command_line.hpp"

namespace zonepack::packer {
namespace {

struct UpdateArguments {
  UpdateOptions options;
  OrphanPolicy orphans = OrphanPolicy::kNearest;
  UnlinkedPolicy unlinked = UnlinkedPolicy::kOdometry;
  JsonOutput json;
};

nlohmann::ordered_json numbers_json(const std::map<std::int32_t, std::int32_t>& numbers) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& [from, to] : numbers) list.push_back({{"from", from}, {"to", to}});
  return list;
}

nlohmann::ordered_json to_json(const UpdateSummary& s, const UpdateOptions& options) {
  nlohmann::ordered_json json;
  json["map"] = options.map.string();
  json["version_before"] = s.version_before;
  json["version"] = s.version;
  json["unchanged"] = s.unchanged;
  json["zones_added"] = s.zones_added;
  json["zones_removed"] = s.zones_removed;
  json["zones_changed"] = s.zones_changed;
  json["zones_kept"] = s.zones_kept;
  json["signatures_before"] = s.signatures_before;
  json["signatures"] = s.signatures;
  json["signatures_added"] = s.signatures_added;
  json["signatures_removed"] = s.signatures_removed;
  json["signatures_shared"] = s.signatures_shared;
  json["signatures_left_out"] = nlohmann::ordered_json::object();
  for (const auto& [zone, count] : s.left_out) json["signatures_left_out"][zone] = count;
  json["signatures_not_chosen"] = s.not_chosen;
  json["signatures_unlinked_dropped"] = s.unlinked_dropped;
  json["orphans"] = s.orphans;
  json["ids_mapped"] = numbers_json(s.ids_mapped);
  json["sessions_mapped"] = numbers_json(s.sessions_mapped);
  json["links_to_kept_zones"] = s.links_to_kept;
  json["alignment"] = nullptr;
  if (s.alignment) {
    json["alignment"] = {{"pairs", s.alignment->pairs},
                         {"rms_m", s.alignment->rms_m},
                         {"largest_m", s.alignment->largest_m},
                         {"scale", s.alignment->scale}};
  }
  json["damaged"] = nlohmann::ordered_json::array();
  for (const Damage& d : s.damages) {
    json["damaged"].push_back(
        {{"signature", d.signature}, {"column", d.column}, {"problem", d.problem}});
  }
  json["written_bytes"] = s.written_bytes;
  json["pack_bytes"] = s.pack_bytes;
  json["smallest_budget_bytes"] = s.smallest_budget_bytes;
  json["warnings"] = s.warnings;
  return json;
}

// "5 to 1103, 6 to 1104 and 12 more".
std::string numbers_text(const std::map<std::int32_t, std::int32_t>& numbers) {
  constexpr std::size_t kShown = 8;
  std::string text;
  std::size_t shown = 0;
  for (const auto& [from, to] : numbers) {
    if (shown == kShown) break;
    text += (shown++ == 0 ? "" : ", ") + std::to_string(from) + " to " + std::to_string(to);
  }
  if (numbers.size() > shown) text += " and " + std::to_string(numbers.size() - shown) + " more";
  return text;
}

void print_zones(const char* word, const std::vector<std::string>& zones, std::ostream& out) {
  if (zones.empty()) return;
  out << "  " << word << ":";
  const char* separator = " ";
  for (const std::string& zone : zones) {
    out << separator << zone;
    separator = ", ";
  }
  out << "\n";
}

void print(const UpdateSummary& s, const UpdateOptions& options, std::ostream& out) {
  for (const std::string& warning : s.warnings) std::cerr << "warning: " << warning << "\n";
  for (const Damage& d : s.damages) {
    std::cerr << "WARNING: signature " << d.signature << " left out, " << d.column << ": "
              << d.problem << "\n";
  }
  if (s.alignment) {
    out << "aligned by " << counted(s.alignment->pairs, "signature") << ": residuals "
        << number_text(s.alignment->rms_m) << " m (rms), at most "
        << number_text(s.alignment->largest_m) << " m; a scale of "
        << number_text(s.alignment->scale) << " would fit best\n";
  }
  if (s.unchanged) {
    out << options.map.string() << ": unchanged, version " << s.version.substr(0, 16) << "\n";
    return;
  }
  out << options.map.string() << ": version " << s.version.substr(0, 16) << ", after "
      << s.version_before.substr(0, 16) << "\n";
  print_zones("added", s.zones_added, out);
  print_zones("removed", s.zones_removed, out);
  print_zones("changed", s.zones_changed, out);
  out << "  " << counted(s.zones_kept, "zone keeps its pack", "zones keep their packs") << "\n"
      << "  " << counted(s.signatures, "signature") << ": " << s.signatures_added << " added, "
      << s.signatures_removed << " removed\n";
  if (s.links_to_kept > 0) {
    out << "  " << counted(s.links_to_kept, "link") << " between zones that were packed and zones "
        << "that stay\n";
  }
  if (!s.ids_mapped.empty()) {
    out << "  " << counted(s.ids_mapped.size(), "signature has", "signatures have")
        << " an id that the map gave to another, and got a new one: " << numbers_text(s.ids_mapped)
        << "\n";
  }
  if (!s.sessions_mapped.empty()) {
    out << "  sessions got new numbers, as the map has others: " << numbers_text(s.sessions_mapped)
        << "\n";
  }
  if (s.not_chosen > 0) {
    out << "  " << counted(s.not_chosen, "signature") << " of other sessions left out (--layers, "
        << "--drop-session)\n";
  }
  out << "  a robot fetches " << size_text(s.written_bytes) << " of packs; smallest budget "
      << size_text(s.smallest_budget_bytes) << "\n";
}

// What options say together; CLI11 checks each by itself.
void require_sense(const UpdateOptions& options) {
  const bool zones = !options.replace.empty() || options.add;
  if (options.source.path.empty()) {
    if (zones) throw CLI::RequiredError("--db (for --replace and --add)");
    if (!options.zones.empty()) throw CLI::RequiredError("--db (for --zones)");
    if (!options.source.placement.trajectory.empty())
      throw CLI::RequiredError("--db (for --align)");
    if (!options.sessions.layers.empty()) throw CLI::RequiredError("--db (for --layers)");
    if (options.sessions.dropped.empty() && options.layers.empty()) {
      throw CLI::RequiredError("one of --db, --drop-session and --layer");
    }
  } else if (!zones) {
    throw CLI::RequiredError("--replace ZONE or --add (with --db)");
  }
}

}  // namespace

void add_update_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<UpdateArguments>();
  UpdateOptions& options = arguments->options;
  CLI::App* const command = app.add_subcommand(
      "update", "Change some zones of a map; the packs of all others stay as they are");
  command->add_option("MAP", options.map, "folder of the map")->required()->type_name("DIR");
  add_source_options(*command, options.source,
                     "the new sessions: the source of the map grown on, or another");
  command
      ->add_option("--zones", options.zones,
                   "zone polygons and portals to take from; default: those of the map")
      ->type_name("ZONES.geojson");
  CLI::Option* const replace =
      command
          ->add_option("--replace", options.replace,
                       "zones whose signatures become those of the database that stand in them")
          ->type_name("ZONE");
  command
      ->add_flag("--add", options.add,
                 "add the zones of --zones that the map does not have or, when there are none, "
                 "signatures that the map does not have to its own zones")
      ->excludes(replace);
  add_session_options(*command, options.layers, options.sessions);
  CLI::Option* const orphans = add_choice_option<OrphanPolicy>(
      *command, "--orphans", arguments->orphans,
      {{"nearest", OrphanPolicy::kNearest},
       {"drop", OrphanPolicy::kDrop},
       {"error", OrphanPolicy::kError}},
      "signatures in no zone: nearest, drop or error; default: as the map was built");
  CLI::Option* const unlinked = add_choice_option<UnlinkedPolicy>(
      *command, "--unlinked", arguments->unlinked,
      {{"odometry", UnlinkedPolicy::kOdometry},
       {"drop", UnlinkedPolicy::kDrop},
       {"error", UnlinkedPolicy::kError},
       {"odometry-all", UnlinkedPolicy::kOdometryAll}},
      "signatures without an optimised pose: odometry, odometry-all, drop or error; default: as "
      "the map was built");
  add_choice_option<DamagedPolicy>(
      *command, "--damaged", options.damaged,
      {{"error", DamagedPolicy::kError}, {"skip", DamagedPolicy::kSkip}},
      "signatures that cannot be read whole: error (default) or skip");
  command->add_option("--jobs", options.jobs, "threads; default one per core")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack update map --db map.db --replace R12 R13",
                          "zonepack update map --db map.db --zones zones.geojson --add",
                          "zonepack update map --layer skeleton=0"});
  command->callback([arguments, orphans, unlinked, &exit_code] {
    UpdateOptions& given = arguments->options;
    require_sense(given);
    if (orphans->count() > 0) given.orphans = arguments->orphans;
    if (unlinked->count() > 0) given.unlinked = arguments->unlinked;
    arguments->json.require_writable();
    Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
    const UpdateSummary summary = update_map(given, progress);
    print(summary, given, arguments->json.text());
    arguments->json.write(to_json(summary, given));
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
