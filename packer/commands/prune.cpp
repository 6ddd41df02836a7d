// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/prune.hpp"

#include <memory>
#include <stdexcept>

#include "packer/build/leftovers.hpp"
#include "packer/commands/options.hpp"
#include "packer/console/words.hpp"
#include "platform/command_line/command_line.hpp"

namespace zonepack::packer {
namespace {

struct PruneArguments {
  std::string folder;
  bool dry_run = false;
  JsonOutput json;
};

void run_prune(const PruneArguments& arguments) {
  arguments.json.require_writable();
  const std::vector<Leftover> leftovers = find_leftovers(arguments.folder);
  std::ostream& out = arguments.json.text();
  ByteCount bytes = 0;
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const Leftover& leftover : leftovers) {
    if (!arguments.dry_run) remove_leftover(arguments.folder, leftover);
    bytes += leftover.bytes;
    out << (arguments.dry_run ? "would remove " : "removed ") << leftover.name << " ("
        << counted(leftover.bytes, "byte") << ")\n";
    files.push_back({{"file", leftover.name}, {"bytes", leftover.bytes}});
  }
  out << arguments.folder << ": " << counted(leftovers.size(), "file") << ", " << size_text(bytes)
      << " " << (arguments.dry_run ? "to remove\n" : "removed\n");
  nlohmann::ordered_json json;
  json["map"] = arguments.folder;
  json["dry_run"] = arguments.dry_run;
  json["files"] = std::move(files);
  json["bytes"] = bytes;
  arguments.json.write(json);
}

}  // namespace

void add_prune_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<PruneArguments>();
  CLI::App* const command = app.add_subcommand(
      "prune", "Remove packs that the manifest does not name and parts that killed builds left");
  command->add_option("DIR", arguments->folder, "folder of the map")->required();
  command->add_flag("--dry-run", arguments->dry_run, "list them, remove nothing");
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack prune map --dry-run", "zonepack prune map"});
  command->callback([arguments, &exit_code] {
    run_prune(*arguments);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
