// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/calibrate/wheel_calibration.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// The arguments of `zoned calibrate`; json may be empty.
struct CalibrateArguments {
  std::string config, can, truth, json;
};

// Reads the log with the settings, estimates wheel scale and track against the truth, and prints
// the YAML to paste with the errors before and after. Returns the exit code: 0, or 1 when something
// could not be read or written, or the drive does not determine them.
int run_calibrate(const CalibrateArguments& arguments);

// The keys of the section odometry that change, as YAML to paste over the present ones.
std::string calibrated_yaml(const WheelCalibration& calibration, const OdometrySettings& odometry);

// What the wheels did over the CAN log `can`, as the settings read it; at least one step.
Outcome<std::vector<WheelStep>> read_wheel_steps(const Settings& settings, const std::string& can);

}  // namespace zonepack
