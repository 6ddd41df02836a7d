// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/log.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/console/words.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/update/held_plan.hpp"
#include "platform/command_line/command_line.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kDigits = 16;  // of a version, as in the names of packs

struct LogArguments {
  std::string folder;
  JsonOutput json;
};

// A version of the map, and what made it from the one before; null for the first that is known.
struct Version {
  std::string digest;
  std::uint64_t zones = 0, signatures = 0;
  ByteCount pack_bytes = 0;
  const VersionChange* change = nullptr;
};

// Newest first.
std::vector<Version> versions_of(const MapReader& map, const std::vector<VersionChange>& changes) {
  const fb::Manifest& manifest = map.manifest();
  Version version;
  version.digest = to_hex(manifest_digest(map.manifest_file()));
  version.zones = manifest.zones()->size();
  for (const fb::Zone* zone : *manifest.zones()) {
    version.signatures += zone->signatures();
    version.pack_bytes += zone->pack_bytes();
  }
  std::vector<Version> versions;
  for (std::size_t i = changes.size(); i-- > 0;) {
    version.change = &changes[i];
    versions.push_back(version);
    version = {to_hex(changes[i].parent), changes[i].zones, changes[i].signatures,
               changes[i].pack_bytes, nullptr};
  }
  versions.push_back(version);
  return versions;
}

nlohmann::ordered_json to_json(const Version& version) {
  nlohmann::ordered_json json;
  json["version"] = version.digest;
  json["parent"] = nullptr;
  json["what"] = nullptr;
  json["zones"] = version.zones;
  json["signatures"] = version.signatures;
  json["pack_bytes"] = version.pack_bytes;
  for (const char* key : {"zones_added", "zones_removed", "zones_changed"}) {
    json[key] = nlohmann::ordered_json::array();
  }
  if (version.change == nullptr) return json;
  json["parent"] = to_hex(version.change->parent);
  json["what"] = version.change->what;
  json["zones_added"] = version.change->added;
  json["zones_removed"] = version.change->removed;
  json["zones_changed"] = version.change->changed;
  return json;
}

void print_names(const char* word, const std::vector<std::string>& names, std::ostream& out) {
  if (names.empty()) return;
  constexpr std::size_t kShown = 16;
  out << "    " << word;
  const char* separator = " ";
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    out << separator << names[i];
    separator = ", ";
  }
  if (names.size() > kShown) out << " and " << names.size() - kShown << " more";
  out << "\n";
}

void print(const Version& version, std::ostream& out) {
  out << version.digest.substr(0, kDigits) << "  " << counted(version.zones, "zone") << ", "
      << counted(version.signatures, "signature") << ", " << size_text(version.pack_bytes) << "\n";
  if (version.change == nullptr) {
    out << "    the first version that is known\n";
    return;
  }
  out << "    " << version.change->what << "\n";
  print_names("added", version.change->added, out);
  print_names("removed", version.change->removed, out);
  print_names("changed", version.change->changed, out);
}

void run_log(const LogArguments& arguments) {
  arguments.json.require_writable();
  const MapReader map(arguments.folder);
  const std::vector<VersionChange> changes = changes_of(map.manifest());
  nlohmann::ordered_json json;
  json["map"] = arguments.folder;
  json["lineage"] = to_hex(std::span(map.manifest().lineage()->data(), sizeof(Digest16)));
  json["versions"] = nlohmann::ordered_json::array();
  std::ostream& out = arguments.json.text();
  for (const Version& version : versions_of(map, changes)) {
    print(version, out);
    json["versions"].push_back(to_json(version));
  }
  arguments.json.write(json);
}

}  // namespace

void add_log_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<LogArguments>();
  CLI::App* const command =
      app.add_subcommand("log", "List the versions of a map, newest first, and what each changed");
  command->add_option("DIR", arguments->folder, "folder of the map")->required();
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack log map", "zonepack log map --json -"});
  command->callback([arguments, &exit_code] {
    run_log(*arguments);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
