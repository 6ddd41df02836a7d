// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/zoneloc/add_replay.hpp"

#include <string>

#include "platform/command_line/command_line.hpp"
#include "runtime/localize/replay/check_command.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::localize {
namespace {

bool take_start(const std::string& text, LoopArguments& into) {
  if (text == "lost") {
    into.lost = true;
    into.start = {};
    return true;
  }
  const auto start = parse_start(text);
  if (!start || start->kind == StartChoice::Kind::kFix) return false;
  into.lost = false;
  into.start = *start;
  return true;
}

// What a recorded drive is made of.
void add_drive(CLI::App& drive, LoopArguments& arguments) {
  add_file(drive, "--config", arguments.config, "settings of the robot (YAML)")->required();
  drive.add_option("--map", arguments.map, "map folder; else map.path of the settings")
      ->type_name("DIR");
  drive.add_option("--can", arguments.can, "CAN log, as candump -l or -L writes it")
      ->type_name("LOG")
      ->required();
  add_file(drive, "--images", arguments.images, "list of images: stamp file, as TUM's rgb.txt")
      ->required();
  add_file(drive, "--calibration", arguments.calibration, "the camera's calibration (YAML)")
      ->required();
  add_file(drive, "--truth", arguments.truth, "true poses, for the figures: t x y z qx qy qz qw");
  add_parsed(drive, "--budget", "SIZE",
             "hard limit of all that grows with the map (default: settings, else the smallest)",
             "a SIZE: bytes, or with a unit: 8MiB, 6.8MiB, 8M, 50MB",
             [&arguments](const std::string& text) {
               arguments.budget = parse_byte_count(text);
               return arguments.budget.has_value();
             });
  drive
      .add_option("--max-signatures", arguments.max_signatures,
                  "most signatures in memory at once; 0: no limit")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1'000'000'000}))
      ->type_name("N");
  add_parsed(drive, "--start", "X,Y,YAW_DEG|truth|lost",
             "where the robot starts; lost: it is searched for in the map (default)",
             "X,Y,YAW_DEG, truth or lost",
             [&arguments](const std::string& text) { return take_start(text, arguments); });
  drive
      .add_option("--latency", arguments.latency_s,
                  "seconds from an image's stamp to its fix (default: 0.15)")
      ->check(CLI::Range(0.0, 60.0))
      ->type_name("SECONDS");
}

}  // namespace

void add_replay(CLI::App& app, LoopArguments& arguments, std::function<int()>& command) {
  CLI::App& replay = *app.add_subcommand(
      "replay",
      "drives a recorded run in simulated time with fixes from its images, found among the zones "
      "that are resident");
  add_drive(replay, arguments);
  add_file(replay, "--fixes", arguments.fixes,
           "write the fixes, as zoned replay --corrections reads them");
  add_file(replay, "--events", arguments.events,
           "write the event log, one JSON object a line ('-': standard output)");
  add_file(replay, "--json", arguments.json, "write the figures as JSON ('-': standard output)");
  const auto drawing = [&replay](const char* name, std::string& file, const char* what) {
    add_file(replay, name, file, what)->check([](const std::string& path) {
      const auto good = report::check_report_name(path);
      return good ? std::string() : good.error().message;
    });
  };
  drawing("--report", arguments.report, "draw the run with its fixes");
  drawing("--picture", arguments.picture, "draw only the plan with the fixes");
  add_file(replay, "--beside", arguments.beside,
           "another localizer's fixes of the same drive, to draw around ours: RTAB-Map's run (CSV "
           "with t, accepted, mx, my, myaw) or poses as TUM's");
  add_file(replay, "--baseline", arguments.baseline,
           "RTAB-Map's own run of the same images (CSV), to draw next to ours");
  add_examples(replay,
               {"zoneloc replay --config robot.yaml --map map --can drive.log --images rgb.txt \\\n"
                "  --calibration camera.yaml --start 0.9,11,-149 --fixes fixes.txt",
                "zoneloc replay --config robot.yaml --map map --can drive.log --images rgb.txt \\\n"
                "  --calibration camera.yaml --truth truth.txt --start truth --json - \\\n"
                "  --report loop.html"});
  replay.callback([&] { command = [&arguments] { return run_loop(arguments); }; });
}

void add_check(CLI::App& app, LoopArguments& arguments, std::function<int()>& command) {
  CLI::App& check = *app.add_subcommand(
      "check",
      "looks over a recorded drive for what the camera's calibration says wrongly, and prints what "
      "to paste into it");
  add_drive(check, arguments);
  add_file(check, "--json", arguments.json, "write the result as JSON ('-': standard output)");
  add_examples(check,
               {"zoneloc check --config robot.yaml --map map --can drive.log --images rgb.txt \\\n"
                "  --calibration camera.yaml --start 0.9,11,-149",
                "zoneloc check --config robot.yaml --map map --can drive.log --images rgb.txt \\\n"
                "  --calibration camera.yaml --truth truth.txt --start truth --json -"});
  check.callback([&] { command = [&arguments] { return run_check(arguments); }; });
}

}  // namespace zonepack::localize
