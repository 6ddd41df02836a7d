// SPDX-License-Identifier: Apache-2.0
// zoned: the robot's program. Wiring only; `replay` lives in runtime/replay, `run` in runtime/live,
// `listen` in runtime/listen, `calibrate` in runtime/calibrate; evaluate_options and learn_options
// are in this folder.
#include <CLI/CLI.hpp>
#include <functional>

#include "platform/command_line/command_line.hpp"
#include "platform/process/signals.hpp"
#include "platform/version/version.hpp"
#include "runtime/calibrate/calibrate_command.hpp"
#include "runtime/listen/listen_command.hpp"
#include "runtime/live/bus/can_source.hpp"
#include "runtime/live/check_command.hpp"
#include "runtime/live/run_command.hpp"
#include "runtime/live/safe_outputs_command.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/replay/replay_command.hpp"
#include "runtime/report/report.hpp"
#include "runtime/zoned/evaluate_options.hpp"
#include "runtime/zoned/learn_options.hpp"

namespace {

using zonepack::ReplayArguments;
using zonepack::RunArguments;

using zonepack::add_file;
using zonepack::add_parsed;
using zonepack::RunChoices;

// What the command line asked for; run once all of it was understood.
using Command = std::function<int()>;

void need(const char* option, const std::string& given) {
  if (given.empty()) throw CLI::RequiredError(option);
}

void add_choices(CLI::App& app, RunChoices& choices) {
  add_file(app, "--config", choices.config, "settings of the robot (YAML)");
  app.add_option("--map", choices.map, "map folder; else map.path of the settings")
      ->type_name("DIR");
  add_file(app, "--corrections", choices.corrections,
           "poses from a localizer: stamp received x y yaw sigma_x sigma_y sigma_yaw [view]");
  add_file(app, "--truth", choices.truth, "true poses: t x y z qx qy qz qw");
  add_parsed(app, "--start", "X,Y,YAW_DEG|truth|fix", "where the robot starts (default: fix)",
             "X,Y,YAW_DEG, truth or fix", [&choices](const std::string& text) {
               const auto start = zonepack::parse_start(text);
               if (start) choices.start = *start;
               return start.has_value();
             });
  add_parsed(
      app, "--budget", "SIZE",
      "hard limit of all that grows with the map (default: settings, else the smallest, up to a "
      "quarter of the memory here)",
      "a SIZE: bytes, or with a unit: 8MiB, 6.8MiB, 8M, 50MB", [&choices](const std::string& text) {
        choices.budget = zonepack::parse_byte_count(text);
        return choices.budget.has_value();
      });
  app.add_option("--max-signatures", choices.max_signatures,
                 "most signatures in memory at once; 0: no limit")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1'000'000'000}))
      ->type_name("N");
  app.add_option("--storage-rate", choices.storage_rate,
                 "bytes read per second, as preloading takes it to be")
      ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{1'000'000'000'000}))
      ->type_name("BYTES_PER_S");
}

void add_replay(CLI::App& app, ReplayArguments& arguments, Command& command) {
  CLI::App& replay = *app.add_subcommand(
      "replay", "drives a recorded run through the robot's own cycle, on simulated time");
  const auto drawing = [&replay](const char* name, std::string& target, const char* help) {
    add_file(replay, name, target, help)->check([](const std::string& path) {
      return zonepack::report::check_report_name(path).error().message;
    });
  };
  add_choices(replay, arguments);
  replay.add_option("--can", arguments.can, "CAN log, as candump -l or -L writes it")
      ->type_name("LOG");
  add_file(replay, "--recording", arguments.recording,
           "what zoned run --record or zonectl dump wrote: instead of settings, map and log");
  add_file(replay, "--events", arguments.events,
           "write the event log, one JSON object a line ('-': standard output)");
  add_file(replay, "--json", arguments.json, "write the summary as JSON ('-': standard output)");
  drawing("--report", arguments.report, "draw the run: .html, .svg or .png");
  drawing("--picture", arguments.picture, "draw only its route, loading curves and bytes");
  add_file(replay, "--baseline", arguments.baseline,
           "RTAB-Map's own curve of this run (CSV), to draw beside ours");
  zonepack::add_examples(
      replay,
      {"zoned replay --config robot.yaml --map map --can drive.log --corrections fixes.txt",
       "zoned replay --config robot.yaml --map map --can drive.log --budget 8MiB --json - \\\n"
       "  --report run.html",
       "zoned replay --recording run.zpr --events events.jsonl"});
  replay.callback([&] {
    if (arguments.recording.empty()) {
      need("--config", arguments.config);
      need("--can", arguments.can);
    } else {
      for (const std::string* const other : {&arguments.config, &arguments.map, &arguments.can,
                                             &arguments.corrections, &arguments.truth}) {
        if (other->empty()) continue;
        throw CLI::ValidationError("--recording", "holds settings, map and inputs; give no other");
      }
    }
    command = [&arguments] { return zonepack::run_replay(arguments); };
  });
}

void add_run(CLI::App& app, RunArguments& arguments, Command& command) {
  CLI::App& run = *app.add_subcommand(
      "run", "keeps the map's zones in memory while the robot drives, until SIGTERM");
  add_choices(run, arguments);
  add_parsed(run, "--can", "SOURCE",
             "socketcan:IFACE: a CAN bus; log:FILE[@SPEED]: a CAN log, played on its own time; "
             "sim:SCRIPT[@SPEED]: a simulated bus (platform/sim/SCRIPT.md)",
             "socketcan:IFACE, log:FILE (for a CAN log), sim:SCRIPT, or one of these two and "
             "@SPEED, 0.001 to "
             "1000000",
             [&arguments](const std::string& text) {
               const auto source = zonepack::parse_can_source(text);
               if (source) arguments.source = *source;
               return source.has_value();
             })
      ->required();
  add_file(run, "--events", arguments.events,
           "write the event log, one JSON object a line ('-': standard output, as they happen)");
  add_file(run, "--json", arguments.json, "write the summary as JSON ('-': standard output)");
  add_file(run, "--record-can", arguments.record_can,
           "write the CAN frames that were received, as candump -l does");
  run.add_flag("--quiet", arguments.quiet,
               "print warnings and errors only, and no line for each zone entered, loaded or "
               "evicted");
  run.add_option_function<std::string>(
         "--socket", [&arguments](const std::string& path) { arguments.socket = path; },
         "where other programs reach this zoned, over $ZONED_SOCKET and serve.socket; '': nowhere")
      ->type_name("PATH");
  run.add_flag("--allow-degraded", arguments.allow_degraded,
               "go on without real-time priority, locked memory or a CAN interface");
  add_file(run, "--record", arguments.record, "write every input, for zoned replay --recording");
  run.add_flag("--check", arguments.check,
               "only say what would be refused, and what of this computer could be better");
  zonepack::add_examples(
      run,
      {"zoned run --config robot.yaml --map map --can socketcan:can0 --check",
       "zoned run --config robot.yaml --map map --can socketcan:can0 --quiet",
       "zoned run --config robot.yaml --map map --can log:drive.log@10 --corrections fixes.txt",
       "zoned run --config robot.yaml --map map --can socketcan:can0 --record run.zpr"});
  run.callback([&] {
    need("--config", arguments.config);
    arguments.program = zonepack::version();
    arguments.commit = zonepack::commit();
    command = [&arguments] {
      return arguments.check ? zonepack::check_run(arguments) : zonepack::run_live(arguments);
    };
  });
}

void add_listen(CLI::App& app, zonepack::ListenArguments& arguments, Command& command) {
  CLI::App& listen = *app.add_subcommand(
      "listen", "shows what the settings read from a CAN bus or a log, and what looks wrong");
  add_file(listen, "--config", arguments.config, "settings of the robot (YAML)")->required();
  add_parsed(listen, "--can", "SOURCE",
             "socketcan:IFACE: a CAN bus, to which nothing is sent; log:FILE or FILE: a whole CAN "
             "log at once; log:FILE@SPEED: on its own time; sim:SCRIPT[@SPEED]: a simulated bus",
             "socketcan:IFACE, log:FILE[@SPEED], sim:SCRIPT[@SPEED] or the name of a CAN log",
             [&arguments](const std::string& text) {
               const auto feed = zonepack::parse_feed_choice(text);
               if (feed) arguments.feed = *feed;
               return feed.has_value();
             })
      ->required();
  listen.add_option("--duration", arguments.duration_s, "end after this time")
      ->check(CLI::Range(0.01, 1e7))
      ->type_name("S");
  listen.add_flag("--once", arguments.once,
                  "show one picture only, after 2 s or --duration; of a log, at its end");
  add_parsed(
      listen, "--expect", "MOTION",
      "what is done with the robot meanwhile; exit with 1 if the wheels do not: forward[=METRES], "
      "backward[=METRES], left[=DEGREES] and right[=DEGREES] (turning on the spot), "
      "left-wheel[=TURNS] and right-wheel[=TURNS] (one wheel, by hand)",
      "forward, backward, left, right, left-wheel or right-wheel, or one of these and "
      "=AMOUNT over 0",
      [&arguments](const std::string& text) {
        arguments.expected = zonepack::parse_expected_motion(text);
        return arguments.expected.has_value();
      });
  add_file(listen, "--truth", arguments.truth,
           "true poses of a log, to compare the wheels with: t x y z qx qy qz qw");
  add_file(listen, "--corrections", arguments.corrections,
           "the same with the poses of a localizer: stamp received x y yaw sigma_x sigma_y "
           "sigma_yaw");
  add_file(listen, "--json", arguments.json,
           "write the last picture as JSON ('-': standard output, and text to standard error)");
  listen.callback([&] {
    if (!arguments.truth.empty() && !arguments.corrections.empty()) {
      throw CLI::ExcludesError("--truth", "--corrections");
    }
    command = [&arguments] { return zonepack::run_listen(arguments); };
  });
  zonepack::add_examples(
      listen,
      {"zoned listen --config robot.yaml --can socketcan:can0",
       "zoned listen --config robot.yaml --can socketcan:can0 --expect forward=1 --duration 10",
       "zoned listen --config robot.yaml --can socketcan:can0 --expect left-wheel=1",
       "zoned listen --config robot.yaml --can drive.log --corrections fixes.txt --json -"});
}

void add_calibrate(CLI::App& app, zonepack::CalibrateArguments& arguments, Command& command) {
  CLI::App& calibrate = *app.add_subcommand(
      "calibrate",
      "estimates wheel scale and track from a drive whose true path is known, or says "
      "which setting does not fit the wheels");
  add_file(calibrate, "--config", arguments.config, "settings of the robot (YAML)")->required();
  calibrate.add_option("--can", arguments.can, "CAN log of the drive")
      ->type_name("LOG")
      ->required();
  add_file(calibrate, "--truth", arguments.truth, "true poses: t x y z qx qy qz qw")->required();
  add_file(calibrate, "--json", arguments.json,
           "write the result as JSON ('-': standard output, and text to standard error)");
  calibrate.callback(
      [&] { command = [&arguments] { return zonepack::run_calibrate(arguments); }; });
  zonepack::add_examples(
      calibrate, {"zoned calibrate --config robot.yaml --can drive.log --truth path.txt",
                  "zoned calibrate --config robot.yaml --can drive.log --truth path.txt --json -"});
}

}  // namespace

// An exception that comes here is a bug: it stops the process.
// NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  zonepack::outlive_file_limits();
  CLI::App app(
      "Keeps the rooms around a robot in memory, within a byte budget.\n"
      "Exit codes: 0 done, 1 the input or the world is bad, 2 usage.",
      "zoned");
  app.set_version_flag(
      "--version",
      zonepack::version_line(
          "zoned", {{"pack format", zonepack::kPackMajor, zonepack::kPackMinor},
                    {"recording format", zonepack::kRecordingMajor, zonepack::kRecordingMinor}}));
  bool safe_outputs = false;
  std::string config;
  app.add_flag("--safe-outputs", safe_outputs,
               "set the output lines of --config to their safe levels, after a crash");
  add_file(app, "--config", config, "settings of the robot (YAML), for --safe-outputs");
  app.require_subcommand(0, 1);  // so that CLI11 names a word it does not know
  ReplayArguments arguments;
  Command command;
  add_replay(app, arguments, command);
  RunArguments run_arguments;
  add_run(app, run_arguments, command);
  zonepack::ListenArguments listen_arguments;
  add_listen(app, listen_arguments, command);
  zonepack::CalibrateArguments calibrate_arguments;
  add_calibrate(app, calibrate_arguments, command);
  zonepack::LearnArguments learn_arguments;
  zonepack::add_learn(app, learn_arguments, command);
  zonepack::EvaluateArguments evaluate_arguments;
  zonepack::add_evaluate(app, evaluate_arguments, command);
  zonepack::add_examples(
      app, {"zoned run --config robot.yaml --map map --can socketcan:can0 --check",
            "zoned run --config robot.yaml --map map --can socketcan:can0",
            "zoned replay --config robot.yaml --map map --can drive.log --report run.html",
            "zoned --safe-outputs --config /etc/zonepack/zoned.yaml"});
  try {
    zonepack::parse_command_line(app, argc, argv);
    if (safe_outputs == !app.get_subcommands().empty() || safe_outputs == config.empty()) {
      throw CLI::RequiredError("A subcommand, or --safe-outputs --config FILE,");
    }
    if (safe_outputs) command = [&config] { return zonepack::run_safe_outputs(config); };
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return command();
}
