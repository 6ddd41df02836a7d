// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay_command.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <string_view>
#include <vector>

#include "platform/atomic_file.hpp"
#include "platform/can_log.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/replay/baseline.hpp"
#include "runtime/replay/replay.hpp"
#include "runtime/replay/run_files.hpp"
#include "runtime/replay/run_report.hpp"
#include "runtime/replay/summary_text.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

int fail(const std::string& message, int exit_code = 1) {
  std::cerr << "zoned replay: " << message << '\n';
  return exit_code;
}

bool read_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

std::string map_fault(const std::string& folder, const Error& error) {
  return folder + ": cannot be opened as a map: " + to_string(error.code) + " (" +
         std::to_string(error.detail) +
         "); it must hold manifest.zpm as written by zonepack build, and zonepack verify tells "
         "more";
}

// Everything read from files, kept while the run refers to it.
struct Inputs {
  Settings settings;
  Catalog catalog;
  std::vector<PoseCorrection> corrections;
  std::optional<TruthTrack> truth;
  std::vector<BaselineRow> baseline;
};

// A complete message for the first thing that is wrong, or nothing.
std::optional<std::string> read_inputs(const ReplayArguments& arguments, Inputs& inputs) {
  LoadedSettings loaded = load_settings(arguments.config);
  if (!loaded.ok()) {
    std::string all = "settings cannot be used";
    for (const std::string& fault : loaded.faults) all += "\n  " + fault;
    return all;
  }
  inputs.settings = std::move(loaded.settings);
  const std::string folder = arguments.map.empty() ? inputs.settings.map.path : arguments.map;
  if (folder.empty()) return "no map: give --map DIR or map.path in " + arguments.config;
  Result<Catalog> catalog = Catalog::open(folder, inputs.settings.memory.payload.mask);
  if (!catalog) return map_fault(folder, catalog.error());
  inputs.catalog = std::move(catalog).value();

  std::string fault;
  if (!arguments.corrections.empty()) {
    auto corrections = read_corrections(arguments.corrections, fault);
    if (!corrections) return fault;
    inputs.corrections = std::move(*corrections);
  }
  if (!arguments.truth.empty()) {
    inputs.truth = read_truth(arguments.truth, fault);
    if (!inputs.truth) return fault;
  }
  if (!arguments.baseline.empty()) return read_baseline(arguments.baseline, inputs.baseline);
  return std::nullopt;
}

CycleConfig cycle_config(const Settings& settings) {
  CycleConfig config;
  config.odometry = settings.odometry.wheels;
  config.filter = settings.pose;
  config.tracker = settings.zones;
  config.preload = settings.preload;
  return config;
}

ReplayInput replay_input(const ReplayArguments& arguments, Inputs& inputs, CanLogReader& log) {
  const Settings& settings = inputs.settings;
  ReplayInput input{inputs.catalog, log};
  input.corrections = std::move(inputs.corrections);
  input.truth = inputs.truth ? &*inputs.truth : nullptr;
  input.start_at_truth = arguments.start.kind == StartChoice::Kind::kTruth;
  if (arguments.start.kind == StartChoice::Kind::kPose) input.start = arguments.start.pose;
  input.cycle = cycle_config(settings);
  input.period_ns = static_cast<std::int64_t>(1e9 / settings.cycle.period_hz + 0.5);
  input.most_frames = settings.cycle.most_frames;
  input.budget = arguments.budget ? arguments.budget : settings.memory.budget;
  input.max_signatures = arguments.max_signatures.value_or(settings.memory.max_signatures);
  input.pinned = settings.memory.pinned;
  input.rates.storage =
      arguments.storage_rate.value_or(static_cast<std::uint64_t>(settings.loading.storage_rate));
  input.rates.decode = static_cast<std::uint64_t>(settings.loading.decode_rate);
  input.events_path = arguments.events;
  return input;
}

void tell_log_faults(const std::string& path, const CanLogSummary& summary) {
  for (const CanLogSummary::Fault& fault : summary.faults) {
    std::cerr << path << ':' << fault.line << ": " << fault.what << '\n';
  }
  const std::uint64_t all = summary.broken_lines + summary.stray_stamps;
  if (all > summary.faults.size()) {
    std::cerr << path << ": " << all - summary.faults.size() << " further lines left out\n";
  }
  if (summary.read_error != 0) {
    std::cerr << path << ": could not be read to its end (errno " << summary.read_error << ")\n";
  }
}

std::optional<std::string> write_results(const ReplayArguments& arguments, const Inputs& inputs,
                                         const ReplayResult& result) {
  const std::string json = summary_json(result.summary);
  if (arguments.json == "-") {
    std::cout << json;
  } else {
    std::cout << summary_table(result.summary);
    if (!arguments.json.empty()) {
      if (const auto written = write_file_atomically(arguments.json, json); !written) {
        return arguments.json + ": cannot be written: " + to_string(written.error().code);
      }
    }
  }
  const RunReportInput run{inputs.catalog.folder, arguments.can, result.summary, result.trace,
                           inputs.baseline};
  if (!arguments.picture.empty()) {
    if (auto problem = report::write_report(arguments.picture, make_run_picture(run))) {
      return problem;
    }
  }
  if (arguments.report.empty()) return std::nullopt;
  return report::write_report(arguments.report, make_run_report(run));
}

}  // namespace

std::optional<StartChoice> parse_start(const std::string& text) {
  if (text == "fix") return StartChoice{StartChoice::Kind::kFix, {}};
  if (text == "truth") return StartChoice{StartChoice::Kind::kTruth, {}};
  std::array<double, 3> numbers{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = rest.find(',');
    const bool last = i + 1 == numbers.size();
    if (last != (comma == std::string_view::npos)) return std::nullopt;
    if (!read_number(rest.substr(0, comma), numbers[i])) return std::nullopt;
    if (!last) rest.remove_prefix(comma + 1);
  }
  const double yaw_rad = numbers[2] * (kPi / 180);
  if (std::abs(yaw_rad) > kLargestAngle_rad) return std::nullopt;
  return StartChoice{StartChoice::Kind::kPose, {numbers[0], numbers[1], wrap_angle(yaw_rad)}};
}

int run_replay(const ReplayArguments& arguments) {
  if (arguments.start.kind == StartChoice::Kind::kTruth && arguments.truth.empty()) {
    return fail("--start truth needs --truth FILE", 2);
  }
  Inputs inputs;
  if (const auto fault = read_inputs(arguments, inputs)) return fail(*fault);
  CanLogReader log(arguments.can, inputs.settings.can.interface);
  if (const auto opened = log.open(); !opened) return fail(log.explain(opened.error()));

  std::string fault;
  auto result = replay(replay_input(arguments, inputs, log), fault);
  tell_log_faults(arguments.can, log.summary());
  if (!result) return fail(fault);
  result->summary.can_rejected += log.summary().broken_lines + log.summary().stray_stamps;
  for (const std::string& text : result->faults) std::cerr << "zoned replay: " << text << '\n';
  for (const std::string& text : result->warnings) {
    std::cerr << "zoned replay: warning: " << text << '\n';
  }
  if (const auto unwritten = write_results(arguments, inputs, *result)) return fail(*unwritten);
  if (result->summary.budget_violations > 0) {
    return fail("a limit was exceeded in " + std::to_string(result->summary.budget_violations) +
                " cycles");
  }
  return 0;
}

}  // namespace zonepack
