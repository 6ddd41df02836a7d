// SPDX-License-Identifier: Apache-2.0
// zoneloc: finds the robot's pose in a camera's images, among the zones in memory. Wiring only.
#include <CLI/CLI.hpp>
#include <functional>

#include "platform/command_line/command_line.hpp"
#include "platform/process/signals.hpp"
#include "platform/version/version.hpp"
#include "runtime/localize/zoneloc/add_query.hpp"
#include "runtime/localize/zoneloc/add_replay.hpp"
#include "runtime/localize/zoneloc/add_run.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/protocol/messages.hpp"

// An exception that comes here is a bug: it stops the process.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  zonepack::outlive_file_limits();
  CLI::App app(
      "Finds the robot's pose in a camera's images, among the map's zones in memory.\n"
      "Exit codes: 0 done, 1 the input or the world is bad, 2 usage.",
      "zoneloc");
  app.set_version_flag("--version",
                       zonepack::version_line(
                           "zoneloc", {{"pack format", zonepack::kPackMajor, zonepack::kPackMinor},
                                       {"protocol", zonepack::kProtocolVersion, {}}}));
  app.require_subcommand(1);
  std::function<int()> command;
  zonepack::localize::CameraRunArguments run;
  zonepack::localize::add_run(app, run, command);
  zonepack::localize::QueryArguments query;
  zonepack::localize::add_query(app, query, command);
  zonepack::localize::LoopArguments replay;
  zonepack::localize::add_replay(app, replay, command);
  zonepack::localize::LoopArguments check;
  zonepack::localize::add_check(app, check, command);
  zonepack::add_examples(
      app, {"zoneloc query --map map --image frame.jpg --calibration camera.yaml --lost",
            "zoneloc run --calibration camera.yaml --camera v4l2:/dev/video0"});
  try {
    zonepack::parse_command_line(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return command();
}
