// SPDX-License-Identifier: Apache-2.0
// zoned: the robot's program. Wiring only; `replay` lives in runtime/replay.
#include <CLI/CLI.hpp>

#include "runtime/replay/replay_command.hpp"
#include "runtime/report/report.hpp"

namespace {

using zonepack::ReplayArguments;

void add_replay(CLI::App& app, ReplayArguments& arguments, int& exit_code) {
  CLI::App& replay = *app.add_subcommand(
      "replay", "drives a recorded run through the robot's own cycle, on simulated time");
  const auto file = [&replay](const char* name, std::string& target, const char* help) {
    return replay.add_option(name, target, help)->type_name("FILE");
  };
  const auto drawing = [&file](const char* name, std::string& target, const char* help) {
    file(name, target, help)->check([](const std::string& path) {
      return zonepack::report::fault_of_report_name(path).value_or(std::string());
    });
  };
  file("--config", arguments.config, "settings of the robot (YAML)")->required();
  replay.add_option("--map", arguments.map, "map folder; else map.path of the settings")
      ->type_name("DIR");
  replay.add_option("--can", arguments.can, "CAN log, as candump -l or -L writes it")
      ->type_name("LOG")
      ->required();
  file("--corrections", arguments.corrections,
       "poses from a localizer: stamp received x y yaw sigma_x sigma_y sigma_yaw");
  file("--truth", arguments.truth, "true poses: t x y z qx qy qz qw");
  replay
      .add_option_function<std::string>(
          "--start",
          [&arguments](const std::string& text) {
            const auto start = zonepack::parse_start(text);
            if (!start) {
              throw CLI::ValidationError("--start",
                                         "'" + text + "' is neither X,Y,YAW_DEG nor truth nor fix");
            }
            arguments.start = *start;
          },
          "where the robot starts (default: fix)")
      ->type_name("X,Y,YAW_DEG|truth|fix");
  replay
      .add_option_function<std::string>(
          "--budget",
          [&arguments](const std::string& text) {
            arguments.budget = zonepack::parse_byte_count(text);
            if (!arguments.budget) {
              throw CLI::ValidationError(
                  "--budget", "'" + text +
                                  "' is no SIZE; give integer bytes, or with suffix KiB, MiB or "
                                  "GiB, such as 8MiB");
            }
          },
          "hard limit of all that grows with the map (default: settings, else the smallest)")
      ->type_name("SIZE");
  replay.add_option("--max-signatures", arguments.max_signatures,
                    "most signatures in memory at once; 0: no limit");
  replay.add_option("--storage-rate", arguments.storage_rate, "bytes read per second")
      ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{1'000'000'000'000}));
  file("--events", arguments.events, "write the event log, one JSON object a line");
  file("--json", arguments.json, "write the summary as JSON ('-': standard output)");
  drawing("--report", arguments.report, "draw the run: .html, .svg or .png");
  drawing("--picture", arguments.picture, "draw only its route, loading curves and bytes");
  file("--baseline", arguments.baseline,
       "RTAB-Map's own curve of this run (CSV), to draw beside ours");
  replay.callback([&] { exit_code = zonepack::run_replay(arguments); });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Keeps the rooms around a robot in memory, within a byte budget.\n"
      "Exit codes: 0 done, 1 the input or the world is bad, 2 usage.",
      "zoned");
  app.set_version_flag("--version", ZONEPACK_VERSION);
  app.require_subcommand(1);
  ReplayArguments arguments;
  int exit_code = 0;
  add_replay(app, arguments, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return exit_code;
}
