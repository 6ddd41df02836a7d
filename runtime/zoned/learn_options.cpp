// SPDX-License-Identifier: Apache-2.0
#include "runtime/zoned/learn_options.hpp"

#include "platform/command_line/command_line.hpp"

namespace zonepack {

void add_learn(CLI::App& app, LearnArguments& arguments, std::function<int()>& command) {
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
    if (!arguments.can.empty() && arguments.config.empty()) throw CLI::RequiredError("--config");
    if (arguments.can.size() != arguments.corrections.size()) {
      throw CLI::ValidationError("--corrections", "give one for each --can");
    }
    command = [&arguments] { return run_learn(arguments); };
  });
  add_examples(
      learn,
      {"zoned learn monday.zpr tuesday.zpr --map map --out habits.zpt",
       "zoned learn --config robot.yaml --map map --out habits.zpt \\\n"
       "  --can monday.log --corrections monday.txt --can tuesday.log --corrections tuesday.txt",
       "zoned learn wednesday.zpr --from habits.zpt --map map --out habits.zpt --json -"});
}

}  // namespace zonepack
