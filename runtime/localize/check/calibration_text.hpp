// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/localize/camera/camera_model.hpp"
#include "runtime/localize/check/calibration_watch.hpp"

namespace zonepack::localize {

// "the camera seems 5.0 +- 0.3 cm lower than camera.yaml says".
std::string finding_text(const CalibrationFinding& finding, const std::string& file);

// "0.1 +- 0.2 %", "-0.4 +- 0.2 cm", "0.03 +- 0.02 degrees".
std::string value_text(const CalibrationFinding& finding);
// "focal length", "height", "pitch", "roll".
const char* name_of(CameraTrait trait) noexcept;

// The keys of a calibration file that hold these traits, to be pasted over the same keys.
std::string calibration_yaml(const CameraModel& camera,
                             const std::vector<CalibrationFinding>& findings);

// {"trait": "height", "value": -0.05, "sigma": 0.003}; metres and radians, of the focal length a
// share.
std::string finding_json(const CalibrationFinding& finding);
// An object; `ok` is null when there were too few fixes to say.
std::string report_json(const CalibrationReport& report);

}  // namespace zonepack::localize
