// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/tune.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "packer/build/provenance.hpp"
#include "packer/commands/options.hpp"
#include "packer/commands/report.hpp"
#include "packer/console/output_path.hpp"
#include "packer/console/text_table.hpp"
#include "packer/console/words.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/preview/ground.hpp"
#include "packer/tune/given_drives.hpp"
#include "packer/tune/held_map.hpp"
#include "packer/tune/tune.hpp"
#include "packer/tune/tune_page.hpp"
#include "packer/update/held_plan.hpp"
#include "packer/zones/zone_file.hpp"
#include "packer/zones/zone_text.hpp"
#include "platform/base/failure.hpp"
#include "platform/base/shell_word.hpp"
#include "platform/command_line/command_line.hpp"
#include "platform/files/atomic_file.hpp"
#include "platform/process/progress.hpp"
#include "runtime/report/format.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::packer {
namespace {

using nlohmann::ordered_json;
using tune::Step;
using tune::Total;
using tune::Track;
using tune::Tuned;

struct TuneArguments {
  std::string folder;
  std::vector<std::string> drives;
  std::string out;
  std::string preview;
  PayloadMask payload = kDefaultPayload;
  std::vector<std::string> pins;
  std::vector<std::string> layers;
  std::optional<ByteCount> load_bytes;
  tune::Options options;
  JsonOutput json;
};

// What a load reads on average over the zones: a measure of the map's own, whether its zones hold
// kilobytes or megabytes.
ByteCount mean_zone(const tune::Layout& layout) {
  ByteCount sum = 0;
  for (const tune::TunedZone& zone : layout.zones) sum += zone.cost.stored;
  return sum / layout.zones.size();
}

void require_layers(const tune::Layout& layout, const std::vector<std::string>& layers,
                    const std::string& folder) {
  for (const std::string& layer : layers) {
    if (std::ranges::any_of(
            layout.zones, [&](const tune::TunedZone& zone) { return zone.zone.layer == layer; })) {
      continue;
    }
    throw std::runtime_error(folder + ": no zone of this map is of layer '" + layer + "'");
  }
}

std::string session_text(const NamedLayer& layer) {
  std::string text = layer.name + "=";
  const char* separator = "";
  for (const auto& [first, last] : layer.sessions) {
    text += separator + std::to_string(first);
    if (last != first) text += "-" + std::to_string(last);
    separator = ",";
  }
  return text;
}

// The command that packs the new zones as the map was packed.
std::string build_command(const TuneArguments& arguments, const fb::Manifest& manifest) {
  std::string folder = arguments.folder;
  while (folder.size() > 1 && folder.ends_with('/')) folder.pop_back();
  std::string command = "zonepack build --db map.db --zones " + shell_word(arguments.out) +
                        " --out " + shell_word(folder + "-tuned");
  const PayloadMask packed = manifest.payload_mask();
  if ((packed | kCoreOnly) != (kEveryPayload | kCoreOnly)) {
    command += " --payload " + payload_text(packed);
  }
  const Packing packing = packing_of(manifest);
  if (packing.orphans == OrphanPolicy::kDrop) command += " --orphans drop";
  switch (packing.unlinked) {
    case UnlinkedPolicy::kDrop:
      command += " --unlinked drop";
      break;
    case UnlinkedPolicy::kOdometryAll:
      command += " --unlinked odometry-all";
      break;
    default:
      break;
  }
  for (const NamedLayer& layer : layers_of(manifest)) {
    command += " --layer " + shell_word(session_text(layer));
  }
  return command;
}

ordered_json to_json(const tune::Saved& saved) {
  return {{"loads_saved", saved.loads},
          {"signatures_saved", saved.signatures},
          {"bytes_saved", saved.stored}};
}

ordered_json to_json(const Step& step, bool reason) {
  ordered_json json{{"change", step.kind == tune::Change::Kind::kSplit ? "split" : "merge"},
                    {"zones", step.names.from},
                    {"into", step.names.into},
                    {"for_budget", step.for_budget},
                    {"smallest_budget_saved_bytes", step.smallest_saved},
                    {"training", to_json(step.judgement.training)},
                    {"held_out", to_json(step.judgement.held_out)}};
  json["held_out"]["drives_better"] = step.judgement.helped;
  json["held_out"]["drives_worse"] = step.judgement.hurt;
  if (reason) json["reason"] = step.reason;
  return json;
}

ordered_json to_json(const Total& total, const std::vector<Track>& tracks) {
  ordered_json json{{"zones", total.zones},
                    {"smallest_budget_bytes", total.smallest.bytes},
                    {"pair", total.smallest.text},
                    {"loads", total.sum.loads},
                    {"signatures_loaded", total.sum.signatures},
                    {"bytes_loaded", total.sum.stored},
                    {"drives", ordered_json::array()}};
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    json["drives"].push_back({{"drive", tracks[i].name},
                              {"visits", total.visits[i]},
                              {"loads", total.drives[i].loads},
                              {"signatures_loaded", total.drives[i].signatures},
                              {"bytes_loaded", total.drives[i].stored}});
  }
  return json;
}

void print_steps(const std::vector<Step>& steps, bool reasons, std::ostream& out) {
  std::vector<std::string> head{"change",          "smallest MiB", "loads",         "MiB",
                                "held out: loads", "MiB",          "better / worse"};
  if (reasons) head.emplace_back("why not");
  TextTable table(std::move(head));
  for (const Step& step : steps) {
    const tune::Judgement& j = step.judgement;
    std::vector<std::string> row{change_text(step),
                                 tune::saved_mib_text(step.smallest_saved),
                                 std::to_string(j.training.loads),
                                 tune::saved_mib_text(j.training.stored),
                                 std::to_string(j.held_out.loads),
                                 tune::saved_mib_text(j.held_out.stored),
                                 std::to_string(j.helped) + " / " + std::to_string(j.hurt)};
    if (reasons) row.push_back(step.reason);
    table.add(std::move(row));
  }
  table.print(out);
}

void print(const TuneArguments& arguments, const Tuned& tuned, std::ostream& out) {
  if (!tuned.made.empty()) {
    out << "What each change saves, in the order made, with " << size_text(arguments.options.budget)
        << ":\n";
    print_steps(tuned.made, false, out);
    const auto for_budget = std::ranges::count(tuned.made, true, &Step::for_budget);
    if (for_budget > 0) {
      out << "The first "
          << (for_budget == 1 ? std::string("change") : std::to_string(for_budget) + " changes")
          << " brought the map into the budget, whatever the drives said.\n";
    }
    out << "\n";
  }
  if (!tuned.rejected.empty()) {
    out << "Not made:\n";
    print_steps(tuned.rejected, true, out);
    out << "\n";
  }
  TextTable table({"", "zones", "smallest MiB", "set by", "loads", "signatures", "MiB read"});
  for (const auto& [name, total] :
       {std::pair{"before", &tuned.before}, std::pair{"after", &tuned.after}}) {
    table.add({name, std::to_string(total->zones), mib_text(total->smallest.bytes),
               total->smallest.text, std::to_string(total->sum.loads),
               std::to_string(total->sum.signatures), mib_text(total->sum.stored)});
  }
  table.print(out);
}

void write_zones(const std::string& path, const std::string& text) {
  if (const Result<void> written = write_file_atomically(path, text); !written) {
    throw std::runtime_error(cannot_write(path, written.error()).message);
  }
}

[[noreturn]] void refuse_budget(const TuneArguments& arguments, const Tuned& tuned) {
  const tune::Smallest& smallest = tuned.after.smallest;
  std::string text = arguments.folder + ": no zones fit " + size_text(arguments.options.budget) +
                     ": " + counted(tuned.made.size(), "cut") + " of " +
                     tuned.before.smallest.text + " and others lower the smallest budget from " +
                     size_text(tuned.before.smallest.bytes) + " to " + size_text(smallest.bytes) +
                     ", set by " + smallest.text + "; ";
  text += tuned.at_limit ? "raise --max-changes, or give --budget " : "give --budget ";
  throw std::runtime_error(text + std::to_string(smallest.bytes) +
                           " or more, or load less with --payload");
}

void run_tune(const TuneArguments& arguments) {
  const MapReader map(arguments.folder);
  const fb::Manifest& manifest = map.manifest();
  const PayloadMask packed = manifest.payload_mask();
  const PayloadMask payload = arguments.payload & packed;
  std::vector<ZoneId> pinned;
  for (const std::string& pin : arguments.pins) {
    for (const ZoneId zone : map.zones_named(pin)) pinned.push_back(zone);
  }
  tune::HeldMap held =
      tune::read_held_map(map, arguments.folder, payload, pinned, arguments.layers);
  require_layers(held.layout, arguments.layers, arguments.folder);
  tune::GivenDrives given =
      tune::read_given_drives(arguments.drives, held.layout, arguments.folder);
  const std::vector<tune::DrivenPath>& drives = given.drives;
  std::ostream& text = arguments.json.text();
  double metres = 0;
  std::size_t visits = 0;
  for (const Track& track : given.tracks) {
    metres += track.metres;
    visits += track.visits.size();
  }
  text << arguments.folder << ": " << counted(held.layout.zones.size(), "zone") << ", "
       << counted(held.signatures.size(), "signature") << "; " << counted(drives.size(), "drive")
       << ", " << report::format_fixed(metres, 0) << " m, " << counted(visits, "zone") << " entered"
       << (given.halves ? "; the first half chooses, the second half judges"
                        : "; each drive judges what the others choose")
       << "\n";
  for (const std::string& warning : given.warnings) text << "warning: " << warning << "\n";
  text << "\n";

  tune::Options options = arguments.options;
  options.load_bytes = arguments.load_bytes.value_or(mean_zone(held.layout));
  const tune::PackScale scale(map, payload);
  const tune::Layout before = held.layout;
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  const Tuned tuned = tune::tune(
      std::move(held.layout), std::move(given.tracks), given.halves, held.signatures, options,
      [&](const tune::TunedZone& zone) { return scale.weigh(zone, held.signatures); },
      [](const tune::Layout& layout) {
        const ZoneFile file = parse_zone_file(zones_geojson(layout.plan()));
        return file.findings.faults.empty() ? std::string()
                                            : "is no zone file: " + file.findings.faults[0].message;
      },
      progress);
  if (tuned.after.smallest.bytes > arguments.options.budget) refuse_budget(arguments, tuned);
  print(arguments, tuned, text);
  write_zones(arguments.out, zones_geojson(tuned.layout.plan()));
  text << "\n" << arguments.out << ": ";
  if (tuned.made.empty()) {
    text << "the zones as they are; no change helps\n";
  } else {
    text << counted(tuned.after.zones, "zone") << " and "
         << counted(tuned.layout.portals.size(), "portal") << "\n";
  }
  if (tuned.at_limit) {
    text << "More changes would help; --max-changes " << arguments.options.most_changes
         << " was reached\n";
  }
  if (!arguments.preview.empty()) {
    const MapDrawing ground = drawing_of(map);
    const report::Report page = tune::make_tune_page({.folder = arguments.folder,
                                                      .budget = arguments.options.budget,
                                                      .before = &before,
                                                      .tuned = &tuned,
                                                      .ground = &ground});
    if (const auto written = report::write_report(arguments.preview, page); !written) {
      throw std::runtime_error(written.error().message);
    }
    text << arguments.preview << ": the zones before and after as a picture\n";
  }
  const std::string command = build_command(arguments, manifest);
  const bool placed = flatbuffers::GetString(manifest.provenance()->source_kind()) == "stella";
  text << "Next: pack them, with what " << arguments.folder << " was packed from as map.db"
       << (placed ? ", and the options that placed it" : "") << ":\n  " << command << "\n";

  ordered_json json;
  json["map"] = arguments.folder;
  json["out"] = arguments.out;
  json["budget_bytes"] = arguments.options.budget;
  json["load_bytes"] = options.load_bytes;
  json["payload"] = payload_text(payload);
  json["drives"] = ordered_json::array();
  for (const tune::DrivenPath& drive : drives) {
    json["drives"].push_back({{"file", drive.file},
                              {"kind", drive.fixes ? "fixes" : "path"},
                              {"poses", drive.poses.size()},
                              {"left_out", drive.left_out}});
  }
  json["before"] = to_json(tuned.before, tuned.tracks);
  json["after"] = to_json(tuned.after, tuned.tracks);
  json["changes"] = ordered_json::array();
  for (const Step& step : tuned.made) json["changes"].push_back(to_json(step, false));
  json["not_made"] = ordered_json::array();
  for (const Step& step : tuned.rejected) json["not_made"].push_back(to_json(step, true));
  json["at_limit"] = tuned.at_limit;
  if (!arguments.preview.empty()) json["picture"] = arguments.preview;
  json["warnings"] = given.warnings;
  json["next"] = command;
  arguments.json.write(json);
}

}  // namespace

void add_tune_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<TuneArguments>();
  tune::Options& options = arguments->options;
  CLI::App* const command =
      app.add_subcommand("tune", "Fit the zones of a map to how robots drive through it");
  command->add_option("DIR", arguments->folder, "folder of the map")->required();
  command
      ->add_option("--drives", arguments->drives,
                   "where robots went: paths (stamp x y z qx qy qz qw) or fixes (stamp received x "
                   "y yaw), in the map's frame; several are judged by each other")
      ->type_name("FILE")
      ->required();
  add_size_option(*command, "--budget", options.budget, "the robot's memory.budget")->required();
  command->add_option("--out", arguments->out, "GeoJSON of the new zones and portals")
      ->type_name("zones.geojson")
      ->required();
  add_payload_option(*command, "--payload", arguments->payload,
                     "what the robot loads besides the core; default features,scan,grid");
  command
      ->add_option("--pin", arguments->pins,
                   "a zone that is always held, and not changed; repeatable")
      ->type_name("ZONE")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--layers", arguments->layers,
                   "zones of other layers are never loaded, as memory.layers has it, and not "
                   "changed")
      ->type_name("NAME,NAME")
      ->delimiter(',')
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--max-changes", options.most_changes, "make at most so many")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  CLI::Option* const load_cost = add_size_option(
      *command, "--load-cost", options.load_bytes,
      "bytes that a load counts besides those it reads; default: as many as a load of this "
      "map reads on average over its zones");
  add_report_option(*command, arguments->preview,
                    "draw the zones before and after: .html, .svg or .png", "--preview");
  arguments->json.add_option(*command);
  command->footer(
      "Tries to cut each zone in two and to make neighbours one, and keeps what makes the drives\n"
      "read less: bytes from storage, and --load-cost for each load. A change is made when it "
      "also\n"
      "helps on drives that it was not chosen on: each is held out in turn; of a single drive, "
      "the\n"
      "second half. While the map needs more than --budget, zones are cut until it fits.");
  add_examples(*command,
               {"zonepack tune map --drives drive.txt --budget 2MiB --out tuned.geojson",
                "zonepack tune map --drives drive.txt --budget 1MiB --out tuned.geojson --preview "
                "tuned.html"});
  command->callback([arguments, load_cost, &exit_code] {
    if (load_cost->count() > 0) arguments->load_bytes = arguments->options.load_bytes;
    require_writable(arguments->out);
    require_writable(arguments->preview);
    arguments->json.require_writable();
    run_tune(*arguments);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
