// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/calibrate/wheel_hints.hpp"

// The words of hints about wheels, and the settings that mend them.
namespace zonepack {

// What is wrong with two sides; signs are of the signals under their present keys.
struct SideFaults {
  bool swapped = false;
  bool left_sign = false, right_sign = false;
};

// "odometry.left (left_position)".
std::string named(const SignalKey& key);

// "30 times".
std::string times_text(double times);

// The line `invert` once the signs of `wrong` are mended.
std::string inverted_too(const OdometrySettings& odometry, const std::vector<std::string>& wrong);

// Each hint's YAML mends all of the faults, because the two change each other's keys. `seen` goes
// on after "odometry.left (NAME) counts backwards" and "left and right wheel are swapped: ".
WheelHint sign_hint(const OdometrySettings& odometry, const SideFaults& faults,
                    const std::string& seen);
WheelHint swap_hint(const OdometrySettings& odometry, const SideFaults& faults,
                    const std::string& seen);

// Turns are reported `times` as large as they are.
WheelHint track_hint(const OdometrySettings& odometry, double times, const std::string& seen);

// A signal that does not go on with the robot, although it may change.
WheelHint silent_hint(const OdometrySettings& odometry, const SignalKey& key, bool changes,
                      const std::string& seen);

}  // namespace zonepack
