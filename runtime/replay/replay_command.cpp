// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay_command.hpp"

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "platform/can/can_log.hpp"
#include "runtime/replay/recorded_run.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/run/figures/baseline.hpp"
#include "runtime/run/figures/summary_text.hpp"
#include "runtime/run/inputs/log_faults.hpp"
#include "runtime/run/inputs/log_match.hpp"
#include "runtime/run/inputs/log_time.hpp"
#include "runtime/run/output_check.hpp"
#include "runtime/run/run_report.hpp"

namespace zonepack {
namespace {

constexpr const char* kProgram = "zoned replay";

void note(const std::string& message) { std::cerr << kProgram << ": " << message << '\n'; }

ReplayInput replay_input(const ReplayArguments& arguments, RunInputs& inputs, CanFrameSource& log) {
  const Settings& settings = inputs.settings;
  ReplayInput input{inputs.catalog, log};
  input.corrections = std::move(inputs.corrections);
  input.commands = std::move(inputs.commands);
  input.truth = inputs.truth ? &*inputs.truth : nullptr;
  input.start = arguments.start;
  input.cycle = cycle_config(settings);
  input.most_frames = settings.cycle.most_frames;
  input.terms = map_terms(arguments, inputs);
  input.events_path = arguments.events;
  return input;
}

Outcome<void> write_results(const ReplayArguments& arguments, const Catalog& catalog,
                            const std::vector<BaselineRow>& baseline, const ReplayResult& result) {
  Failures failed;
  failed.add(result.events_written);
  failed.add(write_summary(result.summary, arguments.json, arguments.events == "-"));
  const std::string& source = arguments.can.empty() ? arguments.recording : arguments.can;
  const RunReportInput run{catalog.folder, source, result.summary, result.trace, baseline};
  if (!arguments.picture.empty()) {
    failed.add(report::write_report(arguments.picture, make_run_picture(run)));
  }
  if (!arguments.report.empty()) {
    failed.add(report::write_report(arguments.report, make_run_report(run)));
  }
  return failed.all();
}

// The end of a replay that worked: results, each of which fails alone, and whether a limit was
// exceeded.
Outcome<void> conclude(const ReplayArguments& arguments, const Catalog& catalog,
                       const std::vector<BaselineRow>& baseline, const ReplayResult& result) {
  for (const std::string& text : result.faults) note(text);
  for (const std::string& text : result.warnings) note("warning: " + text);
  if (auto written = write_results(arguments, catalog, baseline, result); !written) return written;
  return check_limits(result.summary);
}

Outcome<void> replay_from_recording(const ReplayArguments& arguments) {
  auto recording = RecordingReader::open(arguments.recording);
  if (!recording) return recording.error();
  const auto in_recording = [&](const Failure& cause) {
    return Failure{cause.code, arguments.recording + ": " + cause.message};
  };
  const auto run = open_recorded_run(recording->preface());
  if (!run) return in_recording(run.error());
  const auto result = replay_recording(*recording, *run, arguments.events);
  if (!result) return in_recording(result.error());
  if (!recording->note().empty()) note(recording->note());
  if (!result->exact) {
    note(arguments.recording + ": begins with cycle " + std::to_string(result->first_cycle) +
         ", from a guess: decisions until the first fixes may differ from the run's");
  }
  auto concluded = conclude(arguments, run->catalog, {}, result->replay);
  const bool differs = result->exact && result->complete && !result->live_hash.empty() &&
                       result->live_hash != result->replay.summary.event_log_hash;
  if (!differs) return concluded;
  if (!concluded) note(concluded.error().message);
  return failure(arguments.recording +
                     ": the events differ from those of the run (event_log_hash " +
                     result->live_hash + "); replay with the version that recorded it, " +
                     recording->preface().program,
                 ErrorCode::kMismatch);
}

// First and last stamp of each file; nothing where it is absent or empty.
struct InputTimes {
  using Range = std::pair<std::int64_t, std::int64_t>;
  std::optional<Range> corrections, truth;
};

InputTimes times_of(const RunInputs& inputs) {
  InputTimes times;
  for (const PoseCorrection& fix : inputs.corrections) {
    auto& range = times.corrections;
    if (!range) range = {fix.stamp_ns, fix.stamp_ns};
    *range = {std::min(range->first, fix.stamp_ns), std::max(range->second, fix.received_ns)};
  }
  if (inputs.truth) {
    const std::vector<TruthTrack::Sample>& samples = inputs.truth->samples();
    times.truth = {samples.front().t_ns, samples.back().t_ns};
  }
  return times;
}

Outcome<void> replay_log(const ReplayArguments& arguments) {
  if (arguments.start.kind == StartChoice::Kind::kFix && arguments.corrections.empty()) {
    note(
        "warning: nothing ever says where the robot is: give --corrections FILE, or --start "
        "X,Y,YAW_DEG or truth");
  }
  auto inputs = read_run_inputs(arguments);
  if (!inputs) return inputs.error();
  for (const std::string& text : inputs->warnings) note("warning: " + text);
  std::vector<BaselineRow> baseline;
  if (!arguments.baseline.empty()) {
    auto rows = read_baseline(arguments.baseline);
    if (!rows) return rows.error();
    baseline = std::move(*rows);
  }
  CanLogReader log(arguments.can, inputs->settings.can.interface);
  if (const auto opened = log.open(); !opened) {
    return failure(log.explain(opened.error()), opened.error().code);
  }
  if (!inputs->corrections.empty() || !inputs->commands.empty() || inputs->truth) {
    const LogTime time = LogTime::read(arguments.can, inputs->settings.can.interface);
    if (time.steps() && !arguments.corrections.empty()) {
      auto corrections = read_corrections_as_written(arguments.corrections);
      if (!corrections) return corrections.error();
      inputs->corrections = time.on_first_clock(std::move(*corrections));
      for (TimedCommand& command : inputs->commands) {
        command.received_ns = time.on_first_clock(command.received_ns);
      }
    }
    if (inputs->truth) inputs->truth = time.on_first_clock(*inputs->truth);
  }
  LogMatch frames(log);
  const InputTimes times = times_of(*inputs);
  auto result = replay(replay_input(arguments, *inputs, frames));
  tell_log_faults(arguments.can, log.summary());
  if (!result) return result.error();
  const std::string mismatch =
      frames.mismatch(inputs->settings.odometry.wheels, arguments.can, log.summary());
  if (!mismatch.empty()) result->warnings.push_back(mismatch);
  result->summary.can_rejected += log.summary().broken_lines + log.summary().stray_stamps;
  auto concluded = conclude(arguments, inputs->catalog, baseline, *result);
  for (const auto& [path, times_of_file] :
       {std::pair(arguments.corrections, times.corrections), {arguments.truth, times.truth}}) {
    if (!concluded || !times_of_file) continue;
    const auto& [first_ns, last_ns] = *times_of_file;
    concluded = check_overlap(path, first_ns, last_ns, arguments.can, frames);
  }
  return concluded;
}

}  // namespace

int run_replay(const ReplayArguments& arguments) {
  auto done = check_outputs({{"--events", arguments.events, true},
                             {"--json", arguments.json, true},
                             {"--report", arguments.report},
                             {"--picture", arguments.picture}});
  if (done) {
    done = arguments.recording.empty() ? replay_log(arguments) : replay_from_recording(arguments);
  }
  return done ? 0 : report_failure(kProgram, done.error());
}

}  // namespace zonepack
