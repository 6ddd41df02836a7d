// SPDX-License-Identifier: Apache-2.0
#include "runtime/zoned/evaluate_options.hpp"

#include <algorithm>
#include <map>

#include "platform/base/nearest_word.hpp"
#include "platform/command_line/command_line.hpp"
#include "runtime/report/report.hpp"

namespace zonepack {
namespace {

// Files that belong to the --can or --recording before them.
void add_drives(CLI::App& evaluate, EvaluateArguments& arguments) {
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

}  // namespace

void add_evaluate(CLI::App& app, EvaluateArguments& arguments, std::function<int()>& command) {
  CLI::App& evaluate = *app.add_subcommand(
      "evaluate", "replays drives with every choice of map, budget, eviction and preloading");
  add_file(evaluate, "--config", arguments.config, "settings of the robot (YAML)")->required();
  evaluate.add_option("--map", arguments.maps, "map folder; may be given again, to compare maps")
      ->type_name("DIR")
      ->required();
  add_drives(evaluate, arguments);
  add_parsed(evaluate, "--budgets", "SIZE,...|auto",
             "budgets to try; auto: from the smallest to the whole map (default: memory.budget, "
             "else auto)",
             "auto or SIZEs with commas between: 8MiB,10MiB",
             [&arguments](const std::string& text) { return parse_budgets(text, arguments); });
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
              auto parsed = parse_names(text, known);
              if (!parsed) throw CLI::ValidationError(option, parsed.error().message);
              words = std::move(parsed).value();
            },
            help + listed(known))
        ->type_name("NAME,...");
  };
  names("--eviction", "who is evicted (default: settings), of ", eviction_names(),
        arguments.evictions);
  names("--preload", "what is loaded ahead (default: settings), of ", preload_names(),
        arguments.preloads);
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
      ->check(
          [](const std::string& path) { return report::check_report_name(path).error().message; });
  evaluate
      .add_option("--trace-csv", arguments.trace_csv,
                  "write what each run's eviction was told and chose, a file a run")
      ->type_name("DIR");
  add_examples(
      evaluate,
      {"zoned evaluate --config robot.yaml --map map --can drive.log --corrections fixes.txt",
       "zoned evaluate --config robot.yaml --map map --budgets 8MiB,10MiB --eviction lru,sieve \\\n"
       "  --can monday.log --corrections monday.txt --can tuesday.log --corrections tuesday.txt "
       "\\\n"
       "  --json results.json --report results.html",
       "zoned evaluate --config robot.yaml --map map --recording run.zpr --budgets auto --json -"});
  evaluate.callback([&] {
    if (arguments.drives.empty()) throw CLI::RequiredError("--can LOG or --recording FILE");
    command = [&arguments] { return run_evaluate(arguments); };
  });
}

}  // namespace zonepack
