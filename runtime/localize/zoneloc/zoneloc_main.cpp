// SPDX-License-Identifier: Apache-2.0
// zoneloc: finds a camera's pose among the zones that zoned keeps in memory. Wiring only; `replay`
// lives in runtime/localize/replay.
#include <CLI/CLI.hpp>
#include <functional>

#include "platform/command_line/command_line.hpp"
#include "platform/version/version.hpp"
#include "runtime/localize/zoneloc/replay_options.hpp"

int main(int argc, char** argv) {
  CLI::App app("Finds a camera's pose among the zones that zoned keeps in memory.", "zoneloc");
  std::function<int()> command;
  zonepack::localize::LoopArguments replay;
  zonepack::localize::add_replay(app, replay, command);
  app.require_subcommand(1);
  try {
    zonepack::parse_command_line(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return command();
}
