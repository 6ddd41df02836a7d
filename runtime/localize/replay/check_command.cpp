// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/check_command.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <utility>

#include "platform/base/json_text.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/localize/camera/calibration.hpp"
#include "runtime/localize/check/calibration_text.hpp"
#include "runtime/run/output_check.hpp"

namespace zonepack::localize {
namespace {

constexpr const char* kCheckProgram = "zoneloc check";
constexpr int kMostRuns = 8;

struct Checked {
  CameraModel camera;  // put right
  CalibrationReport first;
  std::vector<CalibrationFinding> findings;  // of all runs together
  std::size_t images = 0;
  int runs = 0;
};

// How far to go with what one run says. Matches are found with the camera as it is thought to be,
// which keeps those that agree with it: a run shows only a part of what is wrong, down to two
// fifths. The part follows from how much of the last step the next run misses (the secant method).
class TraitSearch {
 public:
  double step(double shown) {
    double part = 1;
    if (last_step_ != 0) part = std::clamp((last_shown_ - shown) / last_step_, kLeastPart, 1.0);
    last_shown_ = shown;
    return last_step_ = shown / part;
  }

 private:
  static constexpr double kLeastPart = 0.25;
  double last_shown_ = 0, last_step_ = 0;
};

Failure too_few(const LoopArguments& arguments, const Checked& checked) {
  const std::size_t needed = CalibrationWatch::kLeastGroups * CalibrationWatch::kFixesOfGroup;
  return failure(arguments.images + ": " + std::to_string(checked.first.fixes) + " fixes in " +
                 std::to_string(checked.images) + " images are too few to judge " +
                 arguments.calibration + "; about " + std::to_string(needed) +
                 " are needed. Give a longer drive; or, if the calibration is far off, see what "
                 "is matched with zoneloc query --draw");
}

Outcome<Checked> check(const LoopArguments& arguments) {
  const auto camera = read_calibration(arguments.calibration);
  if (!camera) return camera.error();
  Checked out;
  CameraTraits total{}, sigmas{};
  std::array<TraitSearch, kCameraTraits> approach;
  std::vector<CameraTrait> wrong;
  bool settled = false;
  while (!settled && out.runs < kMostRuns) {
    const auto lessons = drive_for_lessons(arguments, kCheckProgram, total);
    if (!lessons) return lessons.error();
    const CalibrationReport report = lessons->watch.report();
    if (out.runs++ == 0) {
      out.first = report;
      out.images = lessons->images;
      if (!report.enough) return too_few(arguments, out);
    }
    for (const CalibrationFinding& finding : report.findings) {
      if (std::ranges::find(wrong, finding.trait) == wrong.end()) wrong.push_back(finding.trait);
    }
    // What is known to be wrong is followed until it no longer changes.
    settled = true;
    for (const CalibrationFinding& finding : lessons->watch.together(wrong)) {
      const auto place = static_cast<std::size_t>(finding.trait);
      const double step = approach[place].step(finding.value);
      total[place] += step;
      sigmas[place] = finding.sigma;
      const double little = std::max(finding.sigma, least_of_note(finding.trait) / 8);
      settled = settled && std::abs(step) < little;
    }
  }
  for (const CameraTrait trait : wrong) {
    const auto place = static_cast<std::size_t>(trait);
    const CalibrationFinding finding{trait, total[place], sigmas[place]};
    if (is_clear(finding)) {
      out.findings.push_back(finding);
    } else {
      total[place] = 0;
    }
  }
  out.camera = corrected(*camera, total);
  return out;
}

std::string text_of(const Checked& checked, const std::string& file) {
  std::string text = std::to_string(checked.first.fixes) + " fixes in " +
                     std::to_string(checked.images) + " images\n\n";
  if (checked.findings.empty()) {
    text += "nothing seems wrong with " + file + ":\n";
    for (const CalibrationFinding& each : checked.first.each) {
      std::string name = name_of(each.trait);
      name.resize(14, ' ');
      text += "  " + name + value_text(each) + '\n';
    }
    return text;
  }
  for (const CalibrationFinding& finding : checked.findings) {
    text += finding_text(finding, file) + '\n';
  }
  return text + "\nPaste over the same keys of " + file + ":\n\n" +
         calibration_yaml(checked.camera, checked.findings);
}

std::string json_of(const Checked& checked) {
  std::string found, each;
  for (const CalibrationFinding& finding : checked.findings) {
    found += (found.empty() ? "" : ", ") + finding_json(finding);
  }
  for (const CalibrationFinding& finding : checked.first.each) {
    each += (each.empty() ? "" : ", ") + finding_json(finding);
  }
  const bool ok = checked.findings.empty();
  return "{\n  \"images\": " + std::to_string(checked.images) +
         ",\n  \"fixes\": " + std::to_string(checked.first.fixes) +
         ",\n  \"runs\": " + std::to_string(checked.runs) +
         ",\n  \"ok\": " + (ok ? "true" : "false") + ",\n  \"findings\": [" + found +
         "],\n  \"tested\": [" + each + "],\n  \"yaml\": " +
         (ok ? "null" : json_quoted(calibration_yaml(checked.camera, checked.findings))) + "\n}\n";
}

Outcome<void> check_and_write(const LoopArguments& arguments) {
  const auto checked = check(arguments);
  if (!checked) return checked.error();
  const bool json_on_output = arguments.json == "-";
  (json_on_output ? std::cerr : std::cout)
      << text_of(*checked, arguments.calibration) << std::flush;
  if (json_on_output) {
    std::cout << json_of(*checked) << std::flush;
    if (!std::cout) return failure("standard output cannot be written");
  } else if (!arguments.json.empty()) {
    const auto written = write_file_atomically(arguments.json, json_of(*checked));
    if (!written) return cannot_write(arguments.json, written.error());
  }
  return {};
}

}  // namespace

int run_check(const LoopArguments& arguments) {
  auto done = check_outputs({{"--json", arguments.json, true}});
  if (done) done = check_and_write(arguments);
  return done ? 0 : report_failure(kCheckProgram, done.error());
}

}  // namespace zonepack::localize
