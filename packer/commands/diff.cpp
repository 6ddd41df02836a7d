// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/diff.hpp"

#include <memory>
#include <string>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/console/text_table.hpp"
#include "packer/console/words.hpp"
#include "packer/inspect/map_diff.hpp"
#include "platform/command_line/command_line.hpp"

namespace zonepack::packer {
namespace {

struct DiffArguments {
  std::string before, after;
  JsonOutput json;
};

const char* word_of(ZoneDiff::Kind kind) {
  switch (kind) {
    case ZoneDiff::Kind::kAdded:
      return "added";
    case ZoneDiff::Kind::kRemoved:
      return "removed";
    case ZoneDiff::Kind::kChanged:
      return "changed";
    case ZoneDiff::Kind::kRedrawn:
      return "redrawn";
  }
  return "";
}

nlohmann::ordered_json names_of(const MapDiff& diff, ZoneDiff::Kind kind) {
  auto names = nlohmann::ordered_json::array();
  for (const ZoneDiff& zone : diff.zones) {
    if (zone.kind == kind) names.push_back(zone.name);
  }
  return names;
}

nlohmann::ordered_json to_json(const MapDiff& diff, const DiffArguments& arguments) {
  nlohmann::ordered_json json;
  json["before"] = arguments.before;
  json["after"] = arguments.after;
  json["version_before"] = diff.version_before;
  json["version_after"] = diff.version_after;
  json["same_map"] = diff.same_map;
  json["same_version"] = diff.version_before == diff.version_after;
  json["zones_added"] = names_of(diff, ZoneDiff::Kind::kAdded);
  json["zones_removed"] = names_of(diff, ZoneDiff::Kind::kRemoved);
  json["zones_changed"] = names_of(diff, ZoneDiff::Kind::kChanged);
  json["zones_redrawn"] = names_of(diff, ZoneDiff::Kind::kRedrawn);
  json["zones_unchanged"] = diff.unchanged;
  json["portals_added"] = diff.portals_added;
  json["portals_removed"] = diff.portals_removed;
  json["layers_changed"] = diff.layers_changed;
  json["signatures_before"] = diff.signatures_before;
  json["signatures_after"] = diff.signatures_after;
  json["pack_bytes_before"] = diff.pack_bytes_before;
  json["pack_bytes_after"] = diff.pack_bytes_after;
  json["zones"] = nlohmann::ordered_json::array();
  auto packs = nlohmann::ordered_json::array();
  for (const ZoneDiff& zone : diff.zones) {
    json["zones"].push_back({{"name", zone.name},
                             {"change", word_of(zone.kind)},
                             {"signatures_before", zone.signatures_before},
                             {"signatures_after", zone.signatures_after},
                             {"pack_bytes_before", zone.pack_bytes_before},
                             {"pack_bytes_after", zone.pack_bytes_after}});
    if (!zone.pack.empty())
      packs.push_back({{"file", zone.pack}, {"bytes", zone.pack_bytes_after}});
  }
  json["fetch"] = {{"packs", std::move(packs)},
                   {"pack_count", diff.fetch_packs},
                   {"pack_bytes", diff.fetch_pack_bytes},
                   {"manifest_bytes", diff.fetch_manifest_bytes},
                   {"bytes", diff.fetch_pack_bytes + diff.fetch_manifest_bytes}};
  return json;
}

void print(const MapDiff& diff, const DiffArguments& arguments, std::ostream& out) {
  out << arguments.before << " (" << diff.version_before.substr(0, 16) << ") to " << arguments.after
      << " (" << diff.version_after.substr(0, 16) << ")";
  if (diff.version_before == diff.version_after) {
    out << ": the same version\n";
    return;
  }
  out << "\n";
  if (!diff.zones.empty()) {
    TextTable table({"zone", "", "signatures", "now", "pack MiB", "now"});
    std::vector<std::string> names;
    for (const ZoneDiff& zone : diff.zones) names.push_back(zone.name);
    for (const std::size_t i : natural_order(names)) {
      const ZoneDiff& zone = diff.zones[i];
      table.add({zone.name, word_of(zone.kind), std::to_string(zone.signatures_before),
                 std::to_string(zone.signatures_after), mib_text(zone.pack_bytes_before),
                 mib_text(zone.pack_bytes_after)});
    }
    table.add({"all", "", std::to_string(diff.signatures_before),
               std::to_string(diff.signatures_after), mib_text(diff.pack_bytes_before),
               mib_text(diff.pack_bytes_after)});
    table.print(out);
  }
  out << counted(diff.unchanged, "zone") << " unchanged";
  if (diff.portals_added + diff.portals_removed > 0) {
    out << "; portals: " << diff.portals_added << " added, " << diff.portals_removed << " removed";
  }
  if (diff.layers_changed) out << "; the layers changed";
  out << "\na robot fetches " << counted(diff.fetch_packs, "pack") << ", "
      << size_text(diff.fetch_pack_bytes) << ", and the manifest, "
      << size_text(diff.fetch_manifest_bytes) << "\n";
  if (!diff.same_map) {
    out << "these are two maps, not versions of one: a robot takes the other one at its start "
           "only\n";
  }
}

}  // namespace

void add_diff_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<DiffArguments>();
  CLI::App* const command = app.add_subcommand(
      "diff", "Compare two versions of a map: zones, signatures, and what a robot must fetch");
  command->add_option("BEFORE", arguments->before, "folder of the map that the robot has")
      ->required()
      ->type_name("DIR");
  command->add_option("AFTER", arguments->after, "folder of the map that it is to have")
      ->required()
      ->type_name("DIR");
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack diff robot-map map", "zonepack diff robot-map map --json -"});
  command->callback([arguments, &exit_code] {
    arguments->json.require_writable();
    const MapReader before(arguments->before);
    const MapReader after(arguments->after);
    const MapDiff diff = diff_maps(before, after);
    print(diff, *arguments, arguments->json.text());
    arguments->json.write(to_json(diff, *arguments));
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
