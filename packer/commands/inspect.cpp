// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/inspect.hpp"

#include <filesystem>
#include <memory>

#include "packer/console/command_line.hpp"
#include "packer/inspect/map_inspection.hpp"
#include "packer/inspect/pack_inspection.hpp"

namespace zonepack::packer {

void add_inspect_command(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string path;
    JsonOutput json;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "inspect", "Show what a map or a pack consists of, from its manifest or index");
  command->add_option("PATH", arguments->path, "folder of a map, or a pack (*.zpk)")
      ->required()
      ->type_name("DIR|PACK");
  arguments->json.add_option(*command);
  command->callback([arguments, &exit_code] {
    const std::string& path = arguments->path;
    std::error_code ignored;
    const bool is_pack = std::filesystem::is_regular_file(path, ignored);
    arguments->json.write(is_pack ? inspect_pack(path, arguments->json.text())
                                  : inspect_map(path, arguments->json.text()));
    exit_code = 0;
  });
}

}  // namespace zonepack::packer
