// SPDX-License-Identifier: Apache-2.0
#include "runtime/evaluate/evaluate_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "platform/base/counted.hpp"
#include "platform/base/nearest_word.hpp"
#include "platform/files/write_output.hpp"
#include "platform/process/progress.hpp"
#include "runtime/evaluate/choices.hpp"
#include "runtime/evaluate/evaluate_json.hpp"
#include "runtime/evaluate/evaluate_report.hpp"
#include "runtime/evaluate/evaluation.hpp"
#include "runtime/evaluate/jobs.hpp"
#include "runtime/run/inputs/log_faults.hpp"
#include "runtime/run/inputs/run_inputs.hpp"
#include "runtime/run/output_check.hpp"

namespace zonepack {
namespace {

constexpr const char* kProgram = "zoned evaluate";

void note(const std::string& message) { std::cerr << kProgram << ": " << message << '\n'; }

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.emplace_back(one.name);
  return names;
}

// Settings and maps. A map is read for the largest budget that it is tried with.
Outcome<Evaluation> open_maps(const EvaluateArguments& arguments) {
  Evaluation evaluation;
  for (const std::string& folder : arguments.maps) {
    RunChoices choices;
    choices.config = arguments.config;
    choices.map = folder;
    if (!arguments.budgets.empty()) choices.budget = *std::ranges::max_element(arguments.budgets);
    auto inputs = read_run_inputs(choices);
    if (!inputs) return inputs.error();
    if (evaluation.maps.empty()) {
      for (const std::string& text : inputs->warnings) note("warning: " + text);
    }
    evaluation.settings = std::move(inputs->settings);
    evaluation.learned = std::move(inputs->learned);
    evaluation.maps.push_back({folder, std::move(inputs->catalog), {}});
  }
  return evaluation;
}

Outcome<void> read_drives(const EvaluateArguments& arguments, Evaluation& evaluation,
                          Progress& progress) {
  progress.start("reading", arguments.drives.size(), "drives");
  std::vector<std::optional<Outcome<Drive>>> read(arguments.drives.size());
  std::vector<std::vector<std::string>> warnings(read.size());
  run_jobs(read.size(), arguments.jobs, [&](std::size_t i) {
    read[i].emplace(read_drive(arguments.drives[i], evaluation.settings, warnings[i]));
    progress.advance();
  });
  for (std::size_t i = 0; i < read.size(); ++i) {
    for (const std::string& text : warnings[i]) note("warning: " + text);
    if (!*read[i]) return read[i]->error();
    if (!(*read[i])->recorded()) tell_log_faults(arguments.drives[i].can, (*read[i])->log);
    evaluation.drives.push_back(std::move(**read[i]));
  }
  for (EvaluatedMap& map : evaluation.maps) {
    for (const Drive& drive : evaluation.drives) {
      auto commands = commands_on(drive, map.catalog);
      if (!commands) return commands.error();
      map.commands.push_back(std::move(*commands));
    }
  }
  progress.finish(counted(read.size(), "drive"));
  return {};
}

// Before a run that would be made for nothing.
Outcome<void> make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return {};
  return failure("--trace-csv: " + folder + ": cannot be made: " + error.message(), ErrorCode::kIo);
}

Outcome<void> write_traces(const std::string& folder, std::vector<Evaluated>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    auto written = write_output(folder + "/" + trace_file_name(i), results[i].order_csv);
    if (!written) return written;
    results[i].order_csv.clear();
  }
  return {};
}

Outcome<void> write_results(const EvaluateArguments& arguments, const Evaluation& evaluation,
                            const std::vector<Choice>& choices, std::vector<Evaluated>& results) {
  Failures failed;
  const std::string table = evaluation_table(evaluation, choices, results);
  if (arguments.json == "-") {
    std::cerr << table << std::flush;
  } else {
    failed.add(write_output("-", table));
  }
  if (!arguments.json.empty()) {
    failed.add(write_output(arguments.json, evaluation_json(evaluation, choices, results)));
  }
  if (!arguments.trace_csv.empty()) failed.add(write_traces(arguments.trace_csv, results));
  if (!arguments.report.empty()) {
    failed.add(report::write_report(arguments.report,
                                    make_evaluation_report(evaluation, choices, results)));
  }
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (results[i].summary.budget_violations == 0) continue;
    failed.add(failure("a limit was exceeded in " +
                           counted(results[i].summary.budget_violations, "cycle") + " of run " +
                           std::to_string(i),
                       ErrorCode::kTooLarge));
  }
  return failed.all();
}

Outcome<void> evaluate_all(const EvaluateArguments& arguments) {
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  auto evaluation = open_maps(arguments);
  if (!evaluation) return evaluation.error();
  if (auto read = read_drives(arguments, *evaluation, progress); !read) return read;
  const auto choices = choices_of(arguments, *evaluation);
  if (!choices) return choices.error();

  progress.start("evaluating", choices->size(), "runs");
  std::vector<std::optional<Outcome<Evaluated>>> outcomes(choices->size());
  run_jobs(choices->size(), arguments.jobs, [&](std::size_t i) {
    outcomes[i].emplace(evaluate(*evaluation, (*choices)[i]));
    progress.advance();
  });
  std::vector<Evaluated> results;
  for (auto& outcome : outcomes) {
    if (!*outcome) return outcome->error();
    results.push_back(std::move(**outcome));
  }
  progress.finish(counted(results.size(), "run"));
  return write_results(arguments, *evaluation, *choices, results);
}

}  // namespace

bool parse_budgets(std::string_view text, EvaluateArguments& arguments) {
  if (text == "auto") {
    arguments.auto_budgets = true;
    return true;
  }
  for (const std::string_view part : parts_of(text)) {
    const auto budget = parse_byte_count(std::string(part));
    if (!budget) return false;
    arguments.budgets.push_back(*budget);
  }
  return true;
}

Outcome<std::vector<std::string>> parse_names(std::string_view text,
                                              const std::vector<std::string>& known) {
  std::vector<std::string> names;
  for (const std::string_view part : parts_of(text)) {
    std::string& name = names.emplace_back(part);
    if (std::ranges::find(known, part) != known.end()) continue;
    return usage_failure("there is no '" + name + "'" + known_words_text(name, known));
  }
  return names;
}

std::vector<std::string> eviction_names() { return names_of(eviction_policies()); }
std::vector<std::string> preload_names() { return names_of(preload_modes()); }

int run_evaluate(const EvaluateArguments& arguments) {
  auto done = check_outputs({{"--json", arguments.json, true}, {"--report", arguments.report}});
  if (done && !arguments.trace_csv.empty()) done = make_folder(arguments.trace_csv);
  if (done) done = evaluate_all(arguments);
  return done ? 0 : report_failure(kProgram, done.error());
}

}  // namespace zonepack
