// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/calibrate_command.hpp"

#include <algorithm>
#include <iostream>

#include "platform/base/number_text.hpp"
#include "platform/can/can_log.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/calibrate/wheel_hints.hpp"
#include "runtime/calibrate/wheel_watch.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/run/inputs/log_faults.hpp"
#include "runtime/run/inputs/log_match.hpp"
#include "runtime/run/inputs/log_time.hpp"
#include "runtime/run/inputs/rejected_text.hpp"
#include "runtime/run/output_check.hpp"

namespace zonepack {
namespace {

constexpr double kDegree = 180 / kPi;

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.insert(0, width - text.size(), ' ');
  return text;
}

std::string row(const char* name, double before, double after, int decimals, const char* unit) {
  std::string text = "  " + std::string(name);
  text.resize(22, ' ');
  return text + padded(decimals_text(before, decimals), 10) +
         padded(decimals_text(after, decimals), 12) + " " + unit + "\n";
}

std::string table(const WheelCalibration& c) {
  const CalibrationErrors& a = c.before;
  const CalibrationErrors& b = c.after;
  return "dead reckoning          present  calibrated\n" +
         row("error at the end", a.end_m, b.end_m, 3, "m") +
         row("RMSE", a.rmse_m, b.rmse_m, 3, "m") +
         row("drift", a.drift_percent, b.drift_percent, 2, "% of the way") +
         row("heading at the end", a.heading_rad * kDegree, b.heading_rad * kDegree, 2, "degrees");
}

std::string key(const char* name, double value, double sigma) {
  return "  " + std::string(name) + ": " + decimals_text(value, 6) + "  # +- " +
         decimals_text(sigma, 6) + "\n";
}

std::string json_of(const char* name, const CalibrationErrors& errors) {
  return "  \"" + std::string(name) + "\": {\"end_m\": " + decimals_text(errors.end_m, 6) +
         ", \"rmse_m\": " + decimals_text(errors.rmse_m, 6) +
         ", \"drift_percent\": " + decimals_text(errors.drift_percent, 6) +
         ", \"heading_rad\": " + decimals_text(errors.heading_rad, 6) + "}";
}

std::string json_of(const WheelCalibration& c, const std::vector<WheelHint>& hints) {
  return "{\n  \"distance_m\": " + decimals_text(c.distance_m, 3) +
         ",\n  \"turned_rad\": " + decimals_text(c.turned_rad, 3) +
         ",\n  \"seconds\": " + decimals_text(c.seconds, 3) +
         ",\n  \"windows\": " + std::to_string(c.windows) +
         ",\n  \"left\": " + decimals_text(c.fitted.left, 9) +
         ",\n  \"right\": " + decimals_text(c.fitted.right, 9) +
         ",\n  \"track_m\": " + decimals_text(c.fitted.track_m, 9) +
         ",\n  \"scale_sigma\": " + decimals_text(c.scale_sigma, 9) +
         ",\n  \"track_sigma_m\": " + decimals_text(c.track_sigma_m, 9) +
         ",\n  \"difference\": " + decimals_text(c.difference, 9) +
         ",\n  \"difference_sigma\": " + decimals_text(c.difference_sigma, 9) +
         ",\n  \"sides_differ\": " + (c.sides_differ ? "true" : "false") + ",\n" +
         json_of("before", c.before) + ",\n" + json_of("after", c.after) +
         ",\n  \"hints\": " + hints_json(hints) + "\n}\n";
}

Outcome<Settings> usable_settings(const std::string& config) {
  auto loaded = load_usable_settings(config);
  if (!loaded) return loaded.error();
  for (const std::string& text : loaded->warnings) std::cerr << "warning: " << text << '\n';
  if (!has_sides(loaded->settings.odometry.wheels.model)) {
    return failure(
        config +
        ": odometry.model: wheel scale and track are those of differential-positions and "
        "wheel-speeds; other models are measured by hand");
  }
  return std::move(loaded->settings);
}

// Whether the drive determines it, and the settings can hold it.
bool can_be_pasted(const WheelCalibration& c, const OdometrySettings& odometry) {
  constexpr double kMostScale = 2;  // config/SETTINGS.md
  constexpr double kMostSigma = 0.2;
  const double mean = (c.fitted.left + c.fitted.right) / 2;
  const double scale = odometry.scale * mean;
  return c.fitted.left > 0 && c.fitted.right > 0 && c.fitted.track_m > 0 &&
         c.scale_sigma < kMostSigma * mean && c.track_sigma_m < kMostSigma * c.fitted.track_m &&
         (!is_length(odometry.unit) || (scale >= 1 / kMostScale && scale <= kMostScale));
}

std::string hint_texts(const std::vector<WheelHint>& hints) {
  std::string text;
  for (const WheelHint& hint : hints) text += hint_text(hint);
  return text;
}

// `why`, and below it what is probably wrong with the settings.
Failure not_calibrated(const std::string& why, const std::vector<WheelHint>& hints) {
  std::string text = why + "\n" + hint_texts(hints);
  text.pop_back();
  return failure(text);
}

// The wheels' steps over the log; `watch` sees every frame.
Outcome<std::vector<WheelStep>> read_steps(const Settings& settings, const std::string& can,
                                           WheelWatch& watch) {
  CanLogReader log(can, settings.can.interface);
  if (const auto opened = log.open(); !opened) {
    return failure(log.explain(opened.error()), opened.error().code);
  }
  const WheelOdometrySettings& wheels = settings.odometry.wheels;
  std::vector<WheelStep> steps;
  LogMatch frames(log);
  while (const auto frame = frames.next()) {
    if (const auto step = watch.take(*frame)) steps.push_back(*step);
  }
  tell_log_faults(can, log.summary());
  if (steps.empty()) {
    const std::string mismatch = frames.mismatch(wheels, can, log.summary());
    if (!mismatch.empty()) return failure(mismatch);
    const std::string why = rejected_text(watch.odometry().counters(), wheels);
    return failure(can + ": holds fewer than two samples that odometry can use" +
                   (why.empty() ? "" : "; refused: " + why));
  }
  return steps;
}

Outcome<void> calibrate_and_report(const CalibrateArguments& arguments) {
  const auto settings = usable_settings(arguments.config);
  if (!settings) return settings.error();
  const OdometrySettings& odometry = settings->odometry;
  const auto as_written = read_truth(arguments.truth);
  if (!as_written) return as_written.error();
  const TruthTrack truth =
      LogTime::read(arguments.can, settings->can.interface).on_first_clock(*as_written);
  WheelWatch watch(*settings, {motion_on(truth), "the true path"});
  const auto steps = read_steps(*settings, arguments.can, watch);
  std::vector<WheelHint> hints = wheel_hints(*settings, watch.evidence());
  if (!steps) return not_calibrated(steps.error().message, hints);
  auto overlap =
      check_overlap(arguments.truth, truth.samples().front().t_ns, truth.samples().back().t_ns,
                    arguments.can, steps->front().from_ns, steps->back().to_ns);
  if (!overlap) return overlap;
  const std::string files = arguments.can + " with " + arguments.truth + ": ";
  const auto result = calibrate(*steps, truth, odometry.wheels);
  if (!result && hints.empty()) return failure(files + result.error().message);
  if (!result) return not_calibrated(files + "the wheels do not follow the path", hints);
  if (!can_be_pasted(*result, odometry)) {
    return not_calibrated(files + "least squares gives a scale of " +
                              short_number((result->fitted.left + result->fitted.right) / 2) +
                              " and a track of " + short_number(result->fitted.track_m) +
                              " m, which no such wheels have",
                          hints);
  }
  // What least squares estimates needs no hint.
  const auto estimated = [](const WheelHint& hint) {
    return hint.kind == "track" || hint.kind == "radius" || hint.kind == "scale";
  };
  hints.erase(std::remove_if(hints.begin(), hints.end(), estimated), hints.end());
  std::cerr << hint_texts(hints);
  const bool json_on_output = arguments.json == "-";
  (json_on_output ? std::cerr : std::cout)
      << arguments.can << ": " << decimals_text(result->distance_m, 1) << " m, "
      << decimals_text(result->turned_rad, 1) << " rad of turning, "
      << decimals_text(result->seconds, 1) << " s in " << result->windows << " windows\n\n"
      << table(*result) << '\n'
      << "left and right wheel: " << decimals_text(result->difference * 100, 3) << " +- "
      << decimals_text(result->difference_sigma * 100, 3) << " % apart, "
      << (result->sides_differ ? "over 3 sigma: told apart"
                               : "less than 3 sigma: taken to be alike")
      << "\n\nPaste over the same keys of " << arguments.config << ":\n\n"
      << calibrated_yaml(*result, odometry);
  if (json_on_output) {
    std::cout << json_of(*result, hints);
  } else if (!arguments.json.empty()) {
    if (const auto written = write_file_atomically(arguments.json, json_of(*result, hints));
        !written) {
      return cannot_write(arguments.json, written.error());
    }
  }
  return {};
}

}  // namespace

Outcome<std::vector<WheelStep>> read_wheel_steps(const Settings& settings, const std::string& can) {
  WheelWatch watch(settings);
  return read_steps(settings, can, watch);
}

std::string calibrated_yaml(const WheelCalibration& calibration, const OdometrySettings& odometry) {
  const WheelCalibration& c = calibration;
  const double mean = (c.fitted.left + c.fitted.right) / 2;
  std::string text = "odometry:\n";
  if (is_length(odometry.unit)) {
    text += key("scale", odometry.scale * mean, odometry.scale * c.scale_sigma);
  } else {
    text += key("wheel_radius", odometry.wheel_radius_m * mean,
                odometry.wheel_radius_m * c.scale_sigma);
  }
  if (c.sides_differ) {
    text += key("scale_left", odometry.scale_left * c.fitted.left / mean, c.difference_sigma / 2);
    text +=
        key("scale_right", odometry.scale_right * c.fitted.right / mean, c.difference_sigma / 2);
  }
  const WheelGeometry& geometry = odometry.wheels.geometry;
  if (geometry.slip_factor == 1) {
    text += key("track", c.fitted.track_m, c.track_sigma_m);
  } else {
    text +=
        key("slip_factor", c.fitted.track_m / geometry.track_m, c.track_sigma_m / geometry.track_m);
  }
  return text;
}

int run_calibrate(const CalibrateArguments& arguments) {
  auto done = check_outputs({{"--json", arguments.json, true}});
  if (done) done = calibrate_and_report(arguments);
  if (!done) {
    std::cerr << "zoned calibrate: " << done.error().message << '\n';
    return exit_code(done.error());
  }
  return 0;
}

}  // namespace zonepack
