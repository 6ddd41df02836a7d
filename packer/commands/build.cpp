// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/build.hpp"

#include <unistd.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "packer/build/leftovers.hpp"
#include "packer/build/map_builder.hpp"
#include "packer/commands/options.hpp"
#include "packer/commands/session_options.hpp"
#include "packer/commands/source_options.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/words.hpp"
#include "platform/base/shell_word.hpp"
#include "platform/command_line/command_line.hpp"

namespace zonepack::packer {
namespace {

struct BuildArguments {
  BuildOptions options;
  JsonOutput json;
};

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

nlohmann::ordered_json to_json(const BuildSummary& s, const std::filesystem::path& out) {
  nlohmann::ordered_json json;
  json["map"] = out.string();
  json["schema_version"] = s.schema_version;
  json["signatures"] = s.signatures;
  json["features"] = s.features;
  json["zones"] = s.packs.size();
  json["signatures_deleted"] = s.deleted;
  json["signatures_unlinked"] = nlohmann::ordered_json::object();
  for (const auto& [session, count] : s.unlinked_by_session) {
    json["signatures_unlinked"][std::to_string(session)] = count;
  }
  json["signatures_unlinked_dropped"] = s.unlinked_dropped;
  json["sessions"] = nlohmann::ordered_json::object();
  for (const auto& [session, count] : s.sessions) json["sessions"][std::to_string(session)] = count;
  json["signatures_not_chosen"] = s.not_chosen;
  json["orphans"] = s.orphans.size();
  json["orphans_dropped"] = s.orphans_dropped;
  json["damaged"] = nlohmann::ordered_json::array();
  for (const Damage& d : s.damages) {
    json["damaged"].push_back(
        {{"signature", d.signature}, {"column", d.column}, {"problem", d.problem}});
  }
  json["charged_bytes"] = s.charged_bytes;
  json["charged_over_feature_rows"] = ratio(s.charged_bytes, s.feature_row_bytes);
  json["charged_over_source"] = ratio(s.charged_bytes, s.source_bytes);
  json["stored_bytes"] = s.stored_bytes;
  json["stored_over_source"] = ratio(s.stored_bytes, s.source_bytes);
  json["source_bytes"] = s.source_bytes;
  json["pack_bytes"] = s.pack_bytes;
  json["smallest_budget_bytes"] = s.smallest.bytes;
  json["unchanged"] = s.unchanged;
  json["warnings"] = s.warnings;
  json["notes"] = s.notes;
  json["signatures_per_zone"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < s.packs.size(); ++i) {
    json["signatures_per_zone"][s.zone_names[i]] = s.packs[i].signatures;
  }
  return json;
}

void print_trouble(const BuildSummary& s, const BuildOptions& options, std::ostream& out) {
  for (const std::string& note : s.notes) out << note << "\n";
  for (const std::string& warning : s.warnings) out << "warning: " << warning << "\n";
  std::map<std::int32_t, std::size_t> unlinked_by_session = s.unlinked_by_session;
  std::size_t unconnected = 0;
  for (const auto& [session, count] : s.unconnected_by_session) {
    unlinked_by_session.erase(session);
    unconnected += count;
  }
  std::size_t unlinked = 0;
  for (const auto& [session, count] : unlinked_by_session) unlinked += count;
  if (unlinked > 0) {
    out << "WARNING: " << counted(unlinked, "signature has", "signatures have")
        << " no optimised pose (";
    const char* separator = "";
    for (const auto& [session, count] : unlinked_by_session) {
      out << separator << "session " << session << ": " << count;
      separator = ", ";
    }
    out << "); "
        << (options.unlinked == UnlinkedPolicy::kDrop
                ? "left out (--unlinked drop)"
                : "placed by odometry, which may be far off (--unlinked odometry)")
        << "\n";
  }
  if (s.not_chosen > 0) {
    out << counted(s.not_chosen, "signature") << " of other sessions left out (--layers, "
        << "--drop-session)\n";
  }
  if (options.unlinked != UnlinkedPolicy::kDrop && s.unlinked_dropped > unconnected) {
    out << "WARNING: "
        << counted(s.unlinked_dropped - unconnected, "signature has", "signatures have")
        << " no pose at all; left out\n";
  }
  if (!s.orphans.empty()) {
    const Orphan& first = s.orphans.front();
    out << "warning: " << counted(s.orphans.size(), "signature stands", "signatures stand")
        << " in no zone (" << s.orphans_text << "; "
        << (options.orphans == OrphanPolicy::kDrop ? "left out" : "given to the nearest")
        << "), such as " << first.id << " at " << point_text(first.p_map) << ", "
        << number_text(first.distance_m) << " m from the nearest zone\n";
  }
  if (s.misdrawn) {
    out << "WARNING: " << options.zones.string() << ": "
        << misdrawn_text(*s.misdrawn, s.orphans.size(), s.signatures + s.orphans_dropped) << "\n";
  }
  for (const SplitZone& split : s.split) {
    out << "zone " << split.name << " was split into " << counted(split.parts, "part") << "\n";
    if (split.narrow_limit > 0) {
      out << "warning: some parts of zone " << split.name
          << " are narrower than 1 cm, because signatures stand that close and --max-zone-bytes is "
             "that low; a robot hardly enters them. About "
          << size_text(split.narrow_limit) << " would do without\n";
    }
  }
  for (const Damage& d : s.damages) {
    out << "WARNING: signature " << d.signature << " left out, " << d.column << ": " << d.problem
        << "\n";
  }
  if (s.features == 0) {
    out << "warning: no signature has features; a localizer will find nothing to match\n";
  }
}

// None while another build writes there: the map itself is in place by now.
std::vector<Leftover> leftovers_of(const std::filesystem::path& folder) {
  try {
    return find_leftovers(folder);
  } catch (const std::runtime_error&) {
    return {};
  }
}

ByteCount bytes_of(const std::vector<Leftover>& leftovers) {
  ByteCount bytes = 0;
  for (const Leftover& leftover : leftovers) bytes += leftover.bytes;
  return bytes;
}

void run_build(const BuildArguments& arguments, std::ostream& text) {
  const BuildOptions& options = arguments.options;
  require_writable_folder(options.out, "--out");
  arguments.json.require_writable();
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  const BuildSummary s = build_map(options, progress);
  print_trouble(s, options, std::cerr);
  text << options.out.string() << ": " << counted(s.signatures, "signature") << ", "
       << counted(s.features, "feature") << " in " << counted(s.packs.size(), "zone")
       << (s.unchanged ? " (unchanged)" : "") << "\n"
       << std::fixed << std::setprecision(3) << "  charged " << size_text(s.charged_bytes) << ", "
       << ratio(s.charged_bytes, s.feature_row_bytes > 0 ? s.feature_row_bytes : s.source_bytes)
       << (s.feature_row_bytes > 0 ? " of the database's feature rows; stored "
                                   : " of the source's points or blocks; stored ")
       << size_text(s.stored_bytes) << ", " << ratio(s.stored_bytes, s.source_bytes)
       << " of the database's own\n"
       << "  smallest budget " << size_text(s.smallest.bytes) << "\n";
  const std::vector<Leftover> leftovers = leftovers_of(options.out);
  if (!leftovers.empty()) {
    text << "  " << counted(leftovers.size(), "file") << " of earlier builds, "
         << size_text(bytes_of(leftovers)) << ", in no use by this map; to remove "
         << (leftovers.size() == 1 ? "it" : "them") << ", once no robot needs the old map: "
         << "zonepack prune " << shell_word(options.out.string()) << "\n";
  }
  nlohmann::ordered_json json = to_json(s, options.out);
  json["prunable_files"] = leftovers.size();
  json["prunable_bytes"] = bytes_of(leftovers);
  arguments.json.write(json);
}

}  // namespace

void add_build_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BuildArguments>();
  BuildOptions& options = arguments->options;
  CLI::App* const command =
      app.add_subcommand("build", "Pack a SLAM map database into one pack per zone and a manifest");
  add_source_options(*command, options.source, "the map to pack")->required();
  command->add_option("--zones", options.zones, "zone polygons and portals, GeoJSON in metres")
      ->required()
      ->type_name("ZONES.geojson");
  command->add_option("--out", options.out, "the map's folder; created when missing")
      ->required()
      ->type_name("DIR");
  add_payload_option(
      *command, "--payload", options.payload,
      "what to pack besides the core, of features,scan,grid,image,depth,userdata,blocks; "
      "default all");
  add_size_option(*command, "--max-zone-bytes", options.max_zone_bytes,
                  "split zones that would charge more into parts along their length");
  add_choice_option<OrphanPolicy>(*command, "--orphans", options.orphans,
                                  {{"nearest", OrphanPolicy::kNearest},
                                   {"drop", OrphanPolicy::kDrop},
                                   {"error", OrphanPolicy::kError}},
                                  "signatures in no zone: nearest (default), drop or error");
  command->add_option("--snap", options.snap_m, "how far portal ends may stand off a border")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0))
      ->type_name("METRES");
  add_choice_option<UnlinkedPolicy>(
      *command, "--unlinked", options.unlinked,
      {{"odometry", UnlinkedPolicy::kOdometry},
       {"drop", UnlinkedPolicy::kDrop},
       {"error", UnlinkedPolicy::kError},
       {"odometry-all", UnlinkedPolicy::kOdometryAll}},
      "signatures without an optimised pose: odometry (default; without sessions that are "
      "connected to no other), odometry-all, drop or error");
  add_choice_option<DamagedPolicy>(
      *command, "--damaged", options.damaged,
      {{"error", DamagedPolicy::kError}, {"skip", DamagedPolicy::kSkip}},
      "signatures that cannot be read whole: error (default) or skip");
  add_session_options(*command, options.layers, options.sessions);
  command
      ->add_option(
          "--detector", options.detector,
          "what found the features, where the map does not say it or says it wrongly: "
          "RTAB-Map's number and settings, such as '8 Kp/MaxFeatures:400;GFTT/MinDistance:7'")
      ->check([](const std::string& text) {
        const bool fits =
            !text.empty() && text.size() <= 1000 && text[0] >= '0' && text[0] <= '9' &&
            std::ranges::all_of(text, [](unsigned char c) { return c >= 32 && c < 127; });
        return fits ? std::string()
                    : "'" + text + "' does not begin with RTAB-Map's number of a detector";
      })
      ->type_name("TEXT");
  command->add_option("--jobs", options.jobs, "threads; default one per core")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack build --db map.db --zones zones.geojson --out map",
                          "zonepack build --db map.db --zones zones.geojson --out map "
                          "--max-zone-bytes 2MiB --payload features,scan,grid",
                          "zonepack build --db map.db --zones zones.geojson --out map --orphans "
                          "error --damaged skip --json -",
                          "zonepack build --db map.db --zones zones.geojson --out map "
                          "--layer skeleton=0 --layers skeleton"});
  command->callback([arguments, &exit_code] {
    run_build(*arguments, arguments->json.text());
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
