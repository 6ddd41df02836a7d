// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/check/calibration_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"

namespace zonepack::localize {
namespace {

struct Unit {
  double per = 1;  // of the value
  int decimals = 1;
  const char* name = "";
};

Unit unit_of(CameraTrait trait) {
  switch (trait) {
    case CameraTrait::kFocal:
      return {100, 1, "%"};
    case CameraTrait::kHeight:
      return {100, 1, "cm"};
    case CameraTrait::kPitch:
    case CameraTrait::kRoll:
      break;
  }
  return {180 / std::numbers::pi, 2, "degrees"};
}

std::string in_unit(double value, double sigma, CameraTrait trait) {
  const Unit unit = unit_of(trait);
  // Not "+- 0.0".
  const double least = std::pow(10.0, -unit.decimals);
  return decimals_text(value * unit.per, unit.decimals) + " +- " +
         decimals_text(std::max(sigma * unit.per, least), unit.decimals) + " " + unit.name;
}

bool holds(const std::vector<CalibrationFinding>& findings, CameraTrait trait) {
  return std::ranges::find(findings, trait, &CalibrationFinding::trait) != findings.end();
}

// A matrix as OpenCV writes it.
std::string matrix_yaml(const char* key, int rows, int columns, std::vector<double> values) {
  std::string text = std::string(key) + ":\n   rows: " + std::to_string(rows) +
                     "\n   cols: " + std::to_string(columns) + "\n   data: [ ";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ", ";
    const double rounded = std::round(values[i] * 1e6) / 1e6;
    text += shortest_number(rounded == 0 ? 0 : rounded);  // no -0
  }
  return text + " ]\n";
}

}  // namespace

const char* name_of(CameraTrait trait) noexcept {
  return trait == CameraTrait::kFocal ? "focal length" : to_string(trait);
}

std::string value_text(const CalibrationFinding& finding) {
  return in_unit(finding.value, finding.sigma, finding.trait);
}

std::string finding_text(const CalibrationFinding& finding, const std::string& file) {
  const std::string size = in_unit(std::abs(finding.value), finding.sigma, finding.trait);
  const bool more = finding.value > 0;
  const std::string says = " than " + file + " says";
  switch (finding.trait) {
    case CameraTrait::kFocal:
      return "the focal length seems " + size + (more ? " longer" : " shorter") + says;
    case CameraTrait::kHeight:
      return "the camera seems " + size + (more ? " higher" : " lower") + says;
    case CameraTrait::kPitch:
      return "the camera seems to look " + size + (more ? " lower" : " higher") + says;
    case CameraTrait::kRoll:
      break;
  }
  return "the camera seems to lean " + size + (more ? " more to the right" : " more to the left") +
         says;
}

std::string calibration_yaml(const CameraModel& camera,
                             const std::vector<CalibrationFinding>& findings) {
  std::string text;
  if (holds(findings, CameraTrait::kFocal)) {
    text += matrix_yaml("camera_matrix", 3, 3,
                        {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
  }
  if (holds(findings, CameraTrait::kHeight) || holds(findings, CameraTrait::kPitch) ||
      holds(findings, CameraTrait::kRoll)) {
    std::vector<double> values;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        values.push_back(camera.T_base_camera(row, column));
      }
    }
    text += matrix_yaml("local_transform", 3, 4, std::move(values));
  }
  return text;
}

std::string finding_json(const CalibrationFinding& finding) {
  return "{\"trait\": " + json_quoted(to_string(finding.trait)) +
         ", \"value\": " + shortest_number(finding.value) +
         ", \"sigma\": " + shortest_number(finding.sigma) + "}";
}

std::string report_json(const CalibrationReport& report) {
  std::string found;
  for (const CalibrationFinding& finding : report.findings) {
    found += (found.empty() ? "" : ", ") + finding_json(finding);
  }
  const char* const ok = !report.enough ? "null" : report.findings.empty() ? "true" : "false";
  return "{\"fixes\": " + std::to_string(report.fixes) + ", \"ok\": " + ok + ", \"findings\": [" +
         found + "]}";
}

}  // namespace zonepack::localize
