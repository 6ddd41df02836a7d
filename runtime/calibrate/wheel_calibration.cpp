// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/wheel_calibration.hpp"

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "runtime/calibrate/least_squares.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack {
namespace {

double square(double value) { return value * value; }

Pose2 moved_by(const WheelStep& step, const CalibrationValues& values) {
  const double left = step.left_m * values.left;
  const double right = step.right_m * values.right;
  return along_arc((left + right) / 2, (right - left) / values.track_m);
}

// Steps that follow each other, with the true motion from the first's start to the last's end.
struct Window {
  std::span<const WheelStep> steps;
  Pose2 true_motion;
  double distance_m = 0;
  double turned_rad = 0;
};

Pose2 motion_of(const Window& window, const CalibrationValues& values) {
  Pose2 pose;
  for (const WheelStep& step : window.steps) pose = compose(pose, moved_by(step, values));
  return pose;
}

void add_window(std::span<const WheelStep> steps, const TruthTrack& truth, double track_m,
                std::vector<Window>& windows) {
  const auto from = truth.at(steps.front().from_ns);
  const auto to = truth.at(steps.back().to_ns);
  if (!from || !to) return;
  Window window{steps, between(*from, *to), 0, 0};
  for (const WheelStep& step : steps) {
    window.distance_m += std::abs(step.left_m + step.right_m) / 2;
    window.turned_rad += std::abs(step.right_m - step.left_m) / track_m;
  }
  windows.push_back(window);
}

std::vector<Window> windows_of(std::span<const WheelStep> steps, const TruthTrack& truth,
                               double track_m) {
  std::vector<Window> windows;
  std::size_t first = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!steps[i].known) {
      first = i + 1;
      continue;
    }
    const double seconds = static_cast<double>(steps[i].to_ns - steps[first].from_ns) * 1e-9;
    if (seconds < kCalibrationWindow_s) continue;
    add_window(steps.subspan(first, i + 1 - first), truth, track_m, windows);
    first = i + 1;
  }
  return windows;
}

// Parameters: mean scale, track, and right - left when the sides are distinguished.
CalibrationValues values_of(std::span<const double> parameters) {
  const double difference = parameters.size() > 2 ? parameters[2] : 0;
  return {parameters[0] - difference / 2, parameters[0] + difference / 2, parameters[1]};
}

// Three residuals a window, each over its standard deviation.
void add_residuals(const Window& window, const CalibrationValues& values,
                   const WheelOdometrySettings& s, std::vector<double>& residuals) {
  constexpr double kFloor_m = 0.001;  // counters and truth are not finer
  const double floor_rad = kFloor_m / s.geometry.track_m;
  const double d = window.distance_m;
  const double t = window.turned_rad;
  const double along = square(s.sigma_forward_per_sqrt_m) * d +
                       square(s.sigma_forward_per_sqrt_rad) * t + square(kFloor_m);
  const double yaw =
      square(s.sigma_yaw_per_sqrt_m) * d + square(s.sigma_yaw_per_sqrt_rad) * t + square(floor_rad);
  const double across =
      square(s.sigma_sideways_per_sqrt_m) * d + yaw * square(d) / 3 + square(kFloor_m);
  const Pose2 error = between(window.true_motion, motion_of(window, values));
  residuals.push_back(error.x_m / std::sqrt(along));
  residuals.push_back(error.y_m / std::sqrt(across));
  residuals.push_back(error.yaw_rad / std::sqrt(yaw));
}

std::optional<LeastSquares> fit(const std::vector<Window>& windows,
                                const WheelOdometrySettings& settings,
                                std::vector<double> parameters) {
  return solve_least_squares(std::move(parameters), [&](std::span<const double> p) {
    std::vector<double> residuals;
    residuals.reserve(windows.size() * 3);
    for (const Window& window : windows) {
      add_residuals(window, values_of(p), settings, residuals);
    }
    return residuals;
  });
}

std::string metres(double value) {
  return std::to_string(static_cast<int>(value * 10) / 10) + "." +
         std::to_string(static_cast<int>(value * 10) % 10);
}

}  // namespace

CalibrationErrors errors_with(const CalibrationValues& values, const std::vector<WheelStep>& steps,
                              const TruthTrack& truth) {
  CalibrationErrors errors;
  std::optional<Pose2> pose;
  double distance = 0;
  double squares = 0;
  std::size_t count = 0;
  Pose2 last;
  for (const WheelStep& step : steps) {
    const auto now = truth.at(step.to_ns);
    if (!now) continue;
    if (!pose) {
      pose = truth.at(step.from_ns);
      if (!pose) continue;
      last = *pose;
    }
    pose = compose(*pose, moved_by(step, values));
    distance += std::hypot(now->x_m - last.x_m, now->y_m - last.y_m);
    last = *now;
    errors.end_m = std::hypot(pose->x_m - now->x_m, pose->y_m - now->y_m);
    errors.heading_rad = between(*now, *pose).yaw_rad;
    squares += square(errors.end_m);
    ++count;
  }
  if (count > 0) errors.rmse_m = std::sqrt(squares / static_cast<double>(count));
  if (distance > 0) errors.drift_percent = 100 * errors.end_m / distance;
  return errors;
}

Outcome<WheelCalibration> calibrate(const std::vector<WheelStep>& steps, const TruthTrack& truth,
                                    const WheelOdometrySettings& settings) {
  WheelCalibration result;
  const double track_m = settings.geometry.track_m * settings.geometry.slip_factor;
  result.nominal.track_m = track_m;
  const std::vector<Window> windows = windows_of(steps, truth, track_m);
  result.windows = windows.size();
  for (const Window& window : windows) {
    result.distance_m += window.distance_m;
    result.turned_rad += window.turned_rad;
    result.seconds +=
        static_cast<double>(window.steps.back().to_ns - window.steps.front().from_ns) * 1e-9;
  }
  if (result.distance_m < kLeastDistance_m || result.turned_rad < kLeastTurn_rad) {
    return failure("the drive is too short: " + metres(result.distance_m) + " m and " +
                   metres(result.turned_rad) +
                   " rad of turning that the truth covers; needed: at least " +
                   metres(kLeastDistance_m) + " m and " + metres(kLeastTurn_rad) +
                   " rad (a full turn), better 100 m with turns both ways, driven slowly");
  }
  const auto common = fit(windows, settings, {1, track_m});
  const auto apart = fit(windows, settings, {1, track_m, 0});
  if (!common || !apart) {
    return failure(
        "least squares found no answer: scale and track cannot be told apart by this drive; "
        "drive straight pieces and turns both ways");
  }
  result.difference = apart->parameters[2];
  result.difference_sigma = apart->sigmas[2];
  result.sides_differ = std::abs(result.difference) > 3 * result.difference_sigma;
  const LeastSquares& chosen = result.sides_differ ? *apart : *common;
  result.fitted = values_of(chosen.parameters);
  result.scale_sigma = chosen.sigmas[0];
  result.track_sigma_m = chosen.sigmas[1];
  result.before = errors_with(result.nominal, steps, truth);
  result.after = errors_with(result.fitted, steps, truth);
  return result;
}

}  // namespace zonepack
