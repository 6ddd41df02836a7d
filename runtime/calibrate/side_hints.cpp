// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/side_hints.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "platform/base/number_text.hpp"
#include "runtime/calibrate/scale_guess.hpp"
#include "runtime/calibrate/side_faults.hpp"

namespace zonepack {
namespace {

constexpr double kLeastForward_m = 0.1;       // of a window that says something about scale
constexpr double kMostTurnPerMetre = 0.15;    // rad; more is not straight
constexpr double kLeastWindowTurn_rad = 0.3;  // of a window that says something about turning
constexpr std::size_t kLeastWindows = 3;
constexpr double kSilent = 0.05;   // share of the true way that counts as none
constexpr double kUsual = 1.33;    // tyres and calibration explain this factor, either way
constexpr double kUsualTrack = 2;  // and skid steering this one
constexpr double kAlike = 0.25;    // windows agree within this share

bool usual(double times, double most) { return times <= most && times >= 1 / most; }

// Median of what windows say, and whether most of them say nearly the same.
struct Median {
  double value = 0;
  std::size_t count = 0;
  bool agreed = false;
};

Median median_of(std::vector<double> values) {
  Median median{0, values.size(), false};
  if (values.empty()) return median;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  median.value = *middle;
  const double band = kAlike * std::abs(median.value);
  const auto near = std::count_if(values.begin(), values.end(), [&](double value) {
    return std::abs(value - median.value) <= band;
  });
  median.agreed = static_cast<std::size_t>(near) * 2 > values.size();
  return median;
}

bool is_straight(const TrueMotion& motion) {
  return motion.forward_known && std::abs(motion.forward_m) >= kLeastForward_m &&
         std::abs(motion.turn_rad) <= kMostTurnPerMetre * std::abs(motion.forward_m);
}

// Of the windows that drive straight (or turn): reported over true.
Median ratio_of(const std::deque<DriveWindow>& windows, bool turning,
                const std::function<double(const DriveWindow&)>& reported) {
  std::vector<double> values;
  for (const DriveWindow& window : windows) {
    const bool use = turning ? std::abs(window.truth.turn_rad) >= kLeastWindowTurn_rad
                             : is_straight(window.truth);
    if (!use) continue;
    values.push_back(reported(window) / (turning ? window.truth.turn_rad : window.truth.forward_m));
  }
  return median_of(std::move(values));
}

// The part of side_hints() that a gyroscope allows, which knows turns only.
std::vector<WheelHint> turn_hints(const Settings& settings, const WheelEvidence& evidence) {
  const OdometrySettings& o = settings.odometry;
  const double turn_track_m = o.wheels.geometry.track_m * o.wheels.geometry.slip_factor;
  constexpr double kMostStraight_rad = 0.05;
  std::vector<double> ratios;  // of the wheels, where the robot does not turn
  double left_m = 0;
  for (const DriveWindow& w : evidence.windows) {
    const bool moves = std::min(std::abs(w.left_m), std::abs(w.right_m)) >= kLeastForward_m;
    if (!moves || std::abs(w.truth.turn_rad) > kMostStraight_rad) continue;
    ratios.push_back(w.left_m / w.right_m);
    left_m += w.left_m;
  }
  const Median straight = median_of(std::move(ratios));
  SideFaults faults;
  if (straight.count >= kLeastWindows && straight.agreed && straight.value < 0) {
    // A robot mostly drives forward.
    faults.left_sign = left_m < 0;
    faults.right_sign = !faults.left_sign;
  }
  const double sign_left = faults.left_sign ? -1 : 1;
  const double sign_right = faults.right_sign ? -1 : 1;
  const Median turn = ratio_of(evidence.windows, true, [&](const DriveWindow& w) {
    return (w.right_m * sign_right - w.left_m * sign_left) / turn_track_m;
  });
  std::vector<WheelHint> hints;
  faults.swapped = turn.count >= kLeastWindows && turn.agreed && turn.value < 0;
  if (faults.swapped) {
    hints.push_back(swap_hint(o, faults,
                              "in " + std::to_string(turn.count) +
                                  " pieces of the drive they turn the other way than " +
                                  evidence.reference + "; or both count backwards"));
  }
  if (faults.left_sign || faults.right_sign) {
    hints.push_back(sign_hint(o, faults,
                              ": left and right go opposite ways where " + evidence.reference +
                                  " shows no turn (if the robot drove forward)"));
  }
  const double times = std::abs(turn.value);
  if (turn.count >= kLeastWindows && turn.agreed && times > 0 && !usual(times, kUsualTrack)) {
    hints.push_back(scale_hint(
        settings, times,
        "the wheels report " + times_text(times) + " the turns of " + evidence.reference));
  }
  return hints;
}

}  // namespace

std::vector<WheelHint> side_hints(const Settings& settings, const WheelEvidence& evidence) {
  const OdometrySettings& o = settings.odometry;
  const auto keys = signal_keys(o);
  const auto& windows = evidence.windows;
  if (std::none_of(windows.begin(), windows.end(),
                   [](const DriveWindow& w) { return w.truth.forward_known; })) {
    return turn_hints(settings, evidence);
  }
  const Median left = ratio_of(windows, false, [](const auto& w) { return w.left_m; });
  const Median right = ratio_of(windows, false, [](const auto& w) { return w.right_m; });
  if (left.count < kLeastWindows) return {};
  std::vector<WheelHint> hints;
  const std::string against = " against " + evidence.reference;
  const auto trace_changes = [&](std::size_t i) {
    constexpr std::uint64_t kMany = 20;
    return i < evidence.traces.size() && evidence.traces[i].changes() > kMany;
  };
  const double largest = std::max(std::abs(left.value), std::abs(right.value));
  for (const auto& [side, index] : {std::pair(left, std::size_t{0}), {right, std::size_t{1}}}) {
    // Next to a wheel that follows, or for a robot whose wheels both stand.
    if (std::abs(side.value) < kSilent * std::min(largest, 1.0) ||
        (largest < kSilent && !side.agreed) || side.value == 0) {
      hints.push_back(silent_hint(o, keys[index], trace_changes(index),
                                  "while the robot moved by " + evidence.reference));
    } else if (!side.agreed) {
      hints.push_back({"unrelated",
                       named(keys[index]) + " does not follow the robot" + against +
                           ": the name, the bits, the byte order or the sign bit are wrong",
                       {}});
    }
  }
  if (hints.size() == 2 && hints[0].kind == "speed-as-position" && hints[1].kind == hints[0].kind) {
    hints.pop_back();  // one line mends both
  }
  if (!hints.empty()) return hints;

  SideFaults faults;
  faults.left_sign = left.value < 0;
  faults.right_sign = right.value < 0;
  const double times = std::sqrt(std::abs(left.value * right.value));
  const double turn_track_m = o.wheels.geometry.track_m * o.wheels.geometry.slip_factor;
  const Median turn = ratio_of(windows, true, [&](const DriveWindow& w) {
    return (w.right_m / right.value - w.left_m / left.value) / turn_track_m;
  });
  const bool turned = turn.count >= kLeastWindows;
  if (turned && std::abs(turn.value) < kSilent) {
    hints.push_back({"same-signal",
                     named(keys[0]) + " and " + named(keys[1]) + " go alike when the robot turns" +
                         against + ": one signal is read for both wheels",
                     {}});
    return hints;
  }
  faults.swapped = turned && turn.agreed && turn.value < 0;
  if (faults.swapped) {
    hints.push_back(swap_hint(o, faults,
                              "in " + std::to_string(turn.count) +
                                  " pieces of the drive they turn the other way than " +
                                  evidence.reference));
  }
  if (faults.left_sign || faults.right_sign) hints.push_back(sign_hint(o, faults, against));
  const double apart = std::abs(left.value / right.value);
  if (!usual(apart, kUsual)) {
    const bool left_off =
        std::abs(std::log(std::abs(left.value))) > std::abs(std::log(std::abs(right.value)));
    const double off = std::abs(left_off ? left.value : right.value);
    hints.push_back(scale_hint(settings, off,
                               named(keys[left_off ? 0 : 1]) + " alone reports " + times_text(off) +
                                   " the way of " + evidence.reference));
    // Settings hold one unit for both sides.
    hints.back().yaml.clear();
    hints.back().text += "; mend it for this signal only, by its factor";
  } else if (!usual(times, kUsual)) {
    hints.push_back(
        scale_hint(settings, times,
                   "the wheels report " + times_text(times) + " the way of " + evidence.reference));
  }
  if (turned && turn.agreed && !usual(std::abs(turn.value), kUsualTrack)) {
    hints.push_back(track_hint(o, std::abs(turn.value),
                               "the wheels report " + times_text(std::abs(turn.value)) +
                                   " the turns of " + evidence.reference));
  }
  return hints;
}

std::vector<WheelHint> twist_hints(const Settings& settings, const WheelEvidence& evidence) {
  const OdometrySettings& o = settings.odometry;
  const auto keys = signal_keys(o);
  const double track_m = o.wheels.geometry.track_m * o.wheels.geometry.slip_factor;
  const Median forward = ratio_of(evidence.windows, false,
                                  [](const DriveWindow& w) { return (w.left_m + w.right_m) / 2; });
  const Median turn = ratio_of(evidence.windows, true, [track_m](const DriveWindow& w) {
    return (w.right_m - w.left_m) / track_m;
  });
  std::vector<WheelHint> hints;
  std::vector<std::string> wrong;
  for (const bool yaw : {false, true}) {
    const Median& found = yaw ? turn : forward;
    const SignalKey& key = keys[yaw ? 1 : 0];
    if (found.count < kLeastWindows) continue;
    if (std::abs(found.value) < 1e-6) {
      hints.push_back(silent_hint(o, key, false, "while the robot moved by " + evidence.reference));
    } else if (!found.agreed) {
      hints.push_back({"unrelated", named(key) + " does not follow " + evidence.reference, {}});
    } else {
      if (found.value < 0) wrong.push_back(key.key);
      if (usual(std::abs(found.value), kUsual)) continue;
      hints.push_back(twist_hint(settings, yaw, std::abs(found.value),
                                 named(key) + " reports " + times_text(std::abs(found.value)) +
                                     " the motion of " + evidence.reference));
    }
  }
  if (!wrong.empty()) {
    std::string text;
    for (const std::string& key : wrong)
      text += (text.empty() ? "odometry." : " and odometry.") + key;
    hints.insert(hints.begin(), {"sign",
                                 text + " counts backwards against " + evidence.reference,
                                 {"odometry:", inverted_too(o, wrong)}});
  }
  return hints;
}

}  // namespace zonepack
