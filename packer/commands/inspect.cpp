// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/inspect.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "packer/commands/options.hpp"
#include "packer/inspect/map_inspection.hpp"
#include "packer/inspect/pack_inspection.hpp"
#include "platform/command_line/command_line.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {
namespace {

struct InspectArguments {
  std::vector<std::string> paths;
  JsonOutput json;
};

nlohmann::ordered_json inspect(const std::string& path, std::ostream& text) {
  std::error_code ignored;
  const bool is_file = std::filesystem::is_regular_file(path, ignored);
  const std::filesystem::path file(path);
  if (is_file && file.filename() == kManifestName) {
    return inspect_map(file.has_parent_path() ? file.parent_path().string() : ".", text);
  }
  return is_file ? inspect_pack(path, text) : inspect_map(path, text);
}

void run_inspect(const InspectArguments& arguments) {
  arguments.json.require_writable();
  std::ostream& text = arguments.json.text();
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& path : arguments.paths) {
    if (!all.empty()) text << "\n";
    all.push_back(inspect(path, text));
  }
  // One path: the object itself, as scripts know it.
  if (all.size() == 1) all = nlohmann::ordered_json(std::move(all.front()));
  arguments.json.write(all);
}

}  // namespace

void add_inspect_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* const command = app.add_subcommand(
      "inspect", "Show what maps or packs consist of, from their manifest or index");
  command->add_option("PATH", arguments->paths, "folder of a map, or a pack (*.zpk); repeatable")
      ->required()
      ->type_name("DIR|PACK");
  arguments->json.add_option(*command);
  add_examples(*command, {"zonepack inspect map", "zonepack inspect map/*.zpk",
                          "zonepack inspect map --json -"});
  command->callback([arguments, &exit_code] {
    run_inspect(*arguments);
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
