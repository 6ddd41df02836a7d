// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay_command.hpp"

#include <iostream>
#include <string>
#include <vector>

#include "platform/can_log.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/replay/recorded_run.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/run/baseline.hpp"
#include "runtime/run/log_faults.hpp"
#include "runtime/run/run_report.hpp"
#include "runtime/run/summary_text.hpp"

namespace zonepack {
namespace {

int fail_replay(const std::string& message, int exit_code = 1) {
  std::cerr << "zoned replay: " << message << '\n';
  return exit_code;
}

ReplayInput replay_input(const ReplayArguments& arguments, RunInputs& inputs, CanLogReader& log) {
  const Settings& settings = inputs.settings;
  ReplayInput input{inputs.catalog, log};
  input.corrections = std::move(inputs.corrections);
  input.truth = inputs.truth ? &*inputs.truth : nullptr;
  input.start_at_truth = arguments.start.kind == StartChoice::Kind::kTruth;
  if (arguments.start.kind == StartChoice::Kind::kPose) input.start = arguments.start.pose;
  input.cycle = cycle_config(settings);
  input.most_frames = settings.cycle.most_frames;
  input.terms = map_terms(arguments, settings);
  input.events_path = arguments.events;
  return input;
}

std::optional<std::string> write_results(const ReplayArguments& arguments, const Catalog& catalog,
                                         const std::vector<BaselineRow>& baseline,
                                         const ReplayResult& result) {
  if (auto problem = write_summary(result.summary, arguments.json)) return problem;
  const std::string& model = arguments.can.empty() ? arguments.recording : arguments.can;
  const RunReportInput run{catalog.folder, model, result.summary, result.trace, baseline};
  if (!arguments.picture.empty()) {
    if (auto drawn = report::write_report(arguments.picture, make_run_picture(run)); !drawn) {
      return drawn.error().message;
    }
  }
  if (arguments.report.empty()) return std::nullopt;
  const auto written = report::write_report(arguments.report, make_run_report(run));
  return written ? std::nullopt : std::optional(written.error().message);
}

// The end of a replay that worked: results, and whether a limit was exceeded.
int tell_results(const ReplayArguments& arguments, const Catalog& catalog,
                 const std::vector<BaselineRow>& baseline, const ReplayResult& result) {
  for (const std::string& text : result.faults) std::cerr << "zoned replay: " << text << '\n';
  for (const std::string& text : result.warnings) {
    std::cerr << "zoned replay: warning: " << text << '\n';
  }
  if (const auto unwritten = write_results(arguments, catalog, baseline, result)) {
    return fail_replay(*unwritten);
  }
  if (result.summary.budget_violations > 0) {
    return fail_replay("a limit was exceeded in " +
                       std::to_string(result.summary.budget_violations) + " cycles");
  }
  return 0;
}

int run_recording(const ReplayArguments& arguments) {
  std::string fault;
  auto recording = RecordingReader::open(arguments.recording, fault);
  if (!recording) return fail_replay(fault);
  const auto run = open_recorded_run(recording->preface(), fault);
  if (!run) return fail_replay(arguments.recording + ": " + fault);
  const auto result = replay_recording(*recording, *run, arguments.events, fault);
  if (!result) return fail_replay(arguments.recording + ": " + fault);
  if (!recording->note().empty()) std::cerr << "zoned replay: " << recording->note() << '\n';
  if (!result->exact) {
    std::cerr << "zoned replay: " << arguments.recording << ": begins with cycle "
              << result->first_cycle
              << ", from a guess: decisions until the first fixes may differ from the run's\n";
  }
  const int exit_code = tell_results(arguments, run->catalog, {}, result->replay);
  if (result->exact && result->complete && !result->live_hash.empty() &&
      result->live_hash != result->replay.summary.event_log_hash) {
    return fail_replay(arguments.recording +
                       ": the events differ from those of the run (event_log_hash " +
                       result->live_hash + "); replay with the version that recorded it, " +
                       recording->preface().program);
  }
  return exit_code;
}

}  // namespace

int run_replay(const ReplayArguments& arguments) {
  if (!arguments.recording.empty()) return run_recording(arguments);
  if (arguments.start.kind == StartChoice::Kind::kTruth && arguments.truth.empty()) {
    return fail_replay("--start truth needs --truth FILE", 2);
  }
  if (arguments.start.kind == StartChoice::Kind::kFix && arguments.corrections.empty()) {
    std::cerr << "zoned replay: warning: nothing ever tells where the robot is: give "
                 "--corrections FILE, or --start X,Y,YAW_DEG or truth\n";
  }
  RunInputs inputs;
  if (const auto fault = read_run_inputs(arguments, inputs)) return fail_replay(*fault);
  std::vector<BaselineRow> baseline;
  if (!arguments.baseline.empty()) {
    if (const auto fault = read_baseline(arguments.baseline, baseline)) return fail_replay(*fault);
  }
  CanLogReader log(arguments.can, inputs.settings.can.interface);
  if (const auto opened = log.open(); !opened) return fail_replay(log.explain(opened.error()));

  std::string fault;
  auto result = replay(replay_input(arguments, inputs, log), fault);
  tell_log_faults(arguments.can, log.summary());
  if (!result) return fail_replay(fault);
  result->summary.can_rejected += log.summary().broken_lines + log.summary().stray_stamps;
  return tell_results(arguments, inputs.catalog, baseline, *result);
}

}  // namespace zonepack
