// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/run/inputs/run_files.hpp"

// Scale of the wheels and track of a robot with a left and a right side, from a drive whose true
// path is known. Not for the control thread.
namespace zonepack {

// What the wheels did between two accepted samples, as the present settings see it.
struct WheelStep {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;
  double left_m = 0;
  double right_m = 0;
  bool known = true;  // false: a gap or a jump, whose path is not known
};

// Corrections of the present settings.
struct CalibrationValues {
  double left = 1;   // true over reported distance of the left wheel
  double right = 1;  // and of the right
  double track_m = 0;
};

struct CalibrationErrors {
  double end_m = 0;          // distance to the truth at the end, when dead reckoning starts at it
  double rmse_m = 0;         // of the distance, over the drive
  double heading_rad = 0;    // at the end, estimate minus truth
  double drift_percent = 0;  // end_m of the distance
};

struct WheelCalibration {
  CalibrationValues nominal, fitted;
  bool sides_differ = false;    // left and right are distinguished: they differ by over 3 sigma
  double scale_sigma = 0;       // standard deviation of the mean of left and right
  double difference_sigma = 0;  // of right - left
  double difference = 0;        // right - left, even if not distinguished
  double track_sigma_m = 0;
  CalibrationErrors before, after;
  double distance_m = 0;
  double turned_rad = 0;  // sum of all turning, either way
  double seconds = 0;
  std::size_t windows = 0;
};

// Least squares over the drive, which is cut into windows of kCalibrationWindow_s: wheels slip at
// random, so the errors of dead reckoning in different windows are independent. Each window's
// motion is compared with the true one, weighted by the noise that the settings give for its
// distance and turn. The two sides are distinguished only when the data show a difference: one that
// is mere noise would bend every later path. Fails when the drive does not determine them, and says
// what drive is needed; the caller adds the names of the files.
inline constexpr double kCalibrationWindow_s = 2;
inline constexpr double kLeastDistance_m = 10;
inline constexpr double kLeastTurn_rad = 6.3;
Outcome<WheelCalibration> calibrate(const std::vector<WheelStep>& steps, const TruthTrack& truth,
                                    const WheelOdometrySettings& settings);

// Dead reckoning with these values against the truth, from the first step that it covers.
CalibrationErrors errors_with(const CalibrationValues& values, const std::vector<WheelStep>& steps,
                              const TruthTrack& truth);

}  // namespace zonepack
