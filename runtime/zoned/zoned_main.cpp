// SPDX-License-Identifier: Apache-2.0
// zoned: the robot's program. Wiring only; `replay` lives in runtime/replay, `run` in runtime/live,
// `listen` in runtime/listen, `calibrate` in runtime/calibrate, `evaluate` in runtime/evaluate,
// `learn` in runtime/learn.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>

#include "platform/base/nearest_word.hpp"
#include "platform/command_line/command_line.hpp"
#include "platform/signals.hpp"
#include "platform/version/version.hpp"
#include "runtime/calibrate/calibrate_command.hpp"
#include "runtime/evaluate/evaluate_command.hpp"
#include "runtime/learn/learn_command.hpp"
#include "runtime/listen/listen_command.hpp"
#include "runtime/live/can_source.hpp"
#include "runtime/live/check_command.hpp"
#include "runtime/live/run_command.hpp"
#include "runtime/live/safe_outputs_command.hpp"
#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/replay/replay_command.hpp"
#include "runtime/report/report.hpp"

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
  add_parsed(
      run, "--can", "SOURCE",
      "socketcan:IFACE: a CAN bus; log:FILE[@SPEED]: a CAN log, played on its own time; "
      "sim:SCRIPT[@SPEED]: a simulated bus (platform/sim/SCRIPT.md)",
      "socketcan:IFACE, log:FILE, sim:SCRIPT, or one of these two and @SPEED, 0.001 to 1000000",
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

void add_learn(CLI::App& app, zonepack::LearnArguments& arguments, Command& command) {
  CLI::App& learn =
      *app.add_subcommand("learn", "counts which zone comes after which, for preload.transitions");
  learn
      .add_option("DRIVE", arguments.drives,
                  "recordings (zoned run --record, a flight folder), or text files of lines "
                  "`stamp zone`; the oldest first")
      ->type_name("FILE");
  learn.add_option("--map", arguments.map, "map folder")->type_name("DIR")->required();
  add_file(learn, "--out", arguments.out, "the file to write (.zpt)")->required();
  add_file(learn, "--config", arguments.config, "settings of the robot (YAML), for --can");
  learn.add_option("--can", arguments.can, "CAN logs, newer than every DRIVE; the oldest first")
      ->type_name("LOG");
  learn
      .add_option("--corrections", arguments.corrections,
                  "the fixes of each CAN log, in the same order")
      ->type_name("FILE");
  add_file(learn, "--from", arguments.from, "go on from what was learned before (.zpt)");
  add_file(learn, "--json", arguments.json,
           "write the result as JSON ('-': standard output, and text to standard error)");
  learn.callback([&] {
    if (arguments.drives.empty() && arguments.can.empty()) {
      throw CLI::RequiredError("A DRIVE, or --can LOG");
    }
    if (!arguments.can.empty()) need("--config", arguments.config);
    if (arguments.can.size() != arguments.corrections.size()) {
      throw CLI::ValidationError("--corrections", "give one for each --can");
    }
    command = [&arguments] { return zonepack::run_learn(arguments); };
  });
  zonepack::add_examples(
      learn,
      {"zoned learn monday.zpr tuesday.zpr --map map --out habits.zpt",
       "zoned learn --config robot.yaml --map map --out habits.zpt \\\n"
       "  --can monday.log --corrections monday.txt --can tuesday.log --corrections tuesday.txt",
       "zoned learn wednesday.zpr --from habits.zpt --map map --out habits.zpt --json -"});
}

// Files that belong to the --can or --recording before them.
void add_drives(CLI::App& evaluate, zonepack::EvaluateArguments& arguments) {
  using zonepack::DriveFiles;
  struct Part {
    const char* name;
    std::string DriveFiles::*file;
    const char* type;
    const char* help;
  };
  static constexpr Part kParts[] = {
      {"--can", &DriveFiles::can, "LOG",
       "CAN log of a drive; may be given again, each with its own"},
      {"--corrections", &DriveFiles::corrections, "FILE", "poses from a localizer on this drive"},
      {"--truth", &DriveFiles::truth, "FILE", "true poses of this drive: t x y z qx qy qz qw"},
      {"--recording", &DriveFiles::recording, "FILE",
       "a drive as zoned run --record or zonectl dump wrote it; only its inputs are used"},
      {"--baseline", &DriveFiles::baseline, "FILE",
       "RTAB-Map's own curve of this drive (CSV), for the report"}};
  for (const Part& part : kParts) {
    evaluate.add_option(part.name, part.help)
        ->type_name(part.type)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
  evaluate.parse_complete_callback([&evaluate, &arguments] {
    std::map<const CLI::Option*, std::size_t> taken;
    for (const CLI::Option* const option : evaluate.parse_order()) {
      const auto part = std::ranges::find_if(kParts, [&](const Part& known) {
        return option == evaluate.get_option_no_throw(known.name);
      });
      if (part == std::end(kParts)) continue;
      const std::string& value = option->results().at(taken[option]++);
      const bool begins = part->file == &DriveFiles::can || part->file == &DriveFiles::recording;
      if (begins) arguments.drives.emplace_back();
      if (arguments.drives.empty()) {
        throw CLI::ValidationError(part->name, "belongs to the --can before it; there is none");
      }
      std::string& file = arguments.drives.back().*part->file;
      const bool of_log =
          part->file == &DriveFiles::corrections || part->file == &DriveFiles::truth;
      if (of_log && arguments.drives.back().can.empty()) {
        throw CLI::ValidationError(part->name, "belongs to a --can; a recording holds its own");
      }
      if (!file.empty()) {
        throw CLI::ValidationError(part->name,
                                   "was given twice for " + arguments.drives.back().name());
      }
      file = value;
    }
    for (const DriveFiles& drive : arguments.drives) {
      if (!drive.can.empty() && drive.corrections.empty()) {
        throw CLI::RequiredError("--corrections FILE after --can " + drive.can);
      }
    }
  });
}

void add_evaluate(CLI::App& app, zonepack::EvaluateArguments& arguments, Command& command) {
  CLI::App& evaluate = *app.add_subcommand(
      "evaluate", "replays drives with every choice of map, budget, eviction and preloading");
  add_file(evaluate, "--config", arguments.config, "settings of the robot (YAML)")->required();
  evaluate.add_option("--map", arguments.maps, "map folder; may be given again, to compare maps")
      ->type_name("DIR")
      ->required();
  add_drives(evaluate, arguments);
  add_parsed(
      evaluate, "--budgets", "SIZE,...|auto",
      "budgets to try; auto: from the smallest to the whole map (default: memory.budget, "
      "else auto)",
      "auto or SIZEs with commas between: 8MiB,10MiB",
      [&arguments](const std::string& text) { return zonepack::parse_budgets(text, arguments); });
  evaluate
      .add_option("--max-signatures", arguments.max_signatures,
                  "limits of signatures in memory to try; 0: none")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1'000'000'000}))
      ->type_name("N,...")
      ->delimiter(',');
  const auto names = [&evaluate](const char* option, const char* help,
                                 const std::vector<std::string>& known,
                                 std::vector<std::string>& words) {
    evaluate
        .add_option_function<std::string>(
            option,
            [option, known, &words](const std::string& text) {
              if (const auto unknown = zonepack::unknown_word(text, known, words)) {
                throw CLI::ValidationError(option, "there is no '" + *unknown + "'" +
                                                       zonepack::known_words_text(*unknown, known));
              }
            },
            help + zonepack::listed(known))
        ->type_name("NAME,...");
  };
  names("--eviction", "who is evicted (default lru), of ", zonepack::eviction_names(),
        arguments.evictions);
  names("--preload", "what is loaded ahead (default portal, as zoned does), of ",
        zonepack::preload_names(), arguments.preloads);
  evaluate
      .add_option("--storage-rate", arguments.storage_rates,
                  "bytes read per second to try (default: settings)")
      ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{1'000'000'000'000}))
      ->type_name("BYTES_PER_S,...")
      ->delimiter(',');
  evaluate.add_option("--jobs", arguments.jobs, "threads; default one per core")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  add_file(evaluate, "--json", arguments.json,
           "write all results as JSON ('-': standard output, and the table to standard error)");
  add_file(evaluate, "--report", arguments.report, "draw the comparison: .html, .svg or .png")
      ->check([](const std::string& path) {
        return zonepack::report::check_report_name(path).error().message;
      });
  evaluate
      .add_option("--trace-csv", arguments.trace_csv,
                  "write what each run's eviction was told and chose, a file a run")
      ->type_name("DIR");
  zonepack::add_examples(
      evaluate,
      {"zoned evaluate --config robot.yaml --map map --can drive.log --corrections fixes.txt",
       "zoned evaluate --config robot.yaml --map map --budgets 8MiB,10MiB --eviction lru,sieve \\\n"
       "  --can monday.log --corrections monday.txt --can tuesday.log --corrections tuesday.txt "
       "\\\n"
       "  --json results.json --report results.html",
       "zoned evaluate --config robot.yaml --map map --recording run.zpr --budgets auto --json -"});
  evaluate.callback([&] {
    if (arguments.drives.empty()) throw CLI::RequiredError("--can LOG or --recording FILE");
    command = [&arguments] { return zonepack::run_evaluate(arguments); };
  });
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
  add_learn(app, learn_arguments, command);
  zonepack::EvaluateArguments evaluate_arguments;
  add_evaluate(app, evaluate_arguments, command);
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
