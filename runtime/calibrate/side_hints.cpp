// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/side_hints.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "runtime/calibrate/number_text.hpp"
#include "runtime/calibrate/scale_guess.hpp"
#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

using Kind = ExpectedMotion::Kind;

constexpr double kLeastForward_m = 0.1;     // of a window that says something about scale
constexpr double kMostTurnPerMetre = 0.15;  // rad; more is not straight
constexpr double kLeastTurn_rad = 0.3;      // of a window that says something about turning
constexpr std::size_t kLeastWindows = 3;
constexpr double kSilent = 0.05;   // share of the true way that counts as none
constexpr double kUsual = 1.33;    // tyres and calibration explain this factor, either way
constexpr double kUsualTrack = 2;  // and skid steering this one
constexpr double kAlike = 0.25;    // windows agree within this share
constexpr double kMostOff = 0.05;  // of a motion that was measured with a tape

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
    const bool use =
        turning ? std::abs(window.truth.turn_rad) >= kLeastTurn_rad : is_straight(window.truth);
    if (!use) continue;
    values.push_back(reported(window) / (turning ? window.truth.turn_rad : window.truth.forward_m));
  }
  return median_of(std::move(values));
}

std::string named(const SignalKey& key) { return "odometry." + key.key + " (" + key.name + ")"; }

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// What is wrong with two sides; signs are of the signals under their present keys.
struct SideFaults {
  bool swapped = false;
  bool left_sign = false, right_sign = false;
};

std::string invert_line(const std::vector<std::string>& keys) {
  std::string text = "  invert: [";
  for (const std::string& key : keys) text += (text.back() == '[' ? "" : ", ") + key;
  return text + "]";
}

// The key `invert` once the signs of `wrong` are mended.
std::string inverted_too(const OdometrySettings& o, const std::vector<std::string>& wrong) {
  std::vector<std::string> keys;
  for (const SignalKey& key : signal_keys(o)) {
    if (contains(o.invert, key.key) != contains(wrong, key.key)) keys.push_back(key.key);
  }
  return invert_line(keys);
}

// The lines of the section odometry that differ once the faults are mended.
std::vector<std::string> side_lines(const OdometrySettings& o, const SideFaults& faults) {
  std::vector<std::string> lines = {"odometry:"};
  bool left = contains(o.invert, "left") != faults.left_sign;
  bool right = contains(o.invert, "right") != faults.right_sign;
  if (faults.swapped) {
    lines.push_back("  left: " + o.right);
    lines.push_back("  right: " + o.left);
    std::swap(left, right);
    if (o.scale_left != o.scale_right) {
      lines.push_back("  scale_left: " + short_number(o.scale_right, 9));
      lines.push_back("  scale_right: " + short_number(o.scale_left, 9));
    }
  }
  if (left != contains(o.invert, "left") || right != contains(o.invert, "right")) {
    std::vector<std::string> keys;
    if (left) keys.emplace_back("left");
    if (right) keys.emplace_back("right");
    lines.push_back(invert_line(keys));
  }
  return lines;
}

std::string times_text(double times) { return short_number(times) + " times"; }

WheelHint sign_hint(const OdometrySettings& o, const SideFaults& faults, const std::string& seen) {
  const auto keys = signal_keys(o);
  std::string which;
  if (faults.left_sign) which = named(keys[0]);
  if (faults.right_sign) which += (which.empty() ? "" : " and ") + named(keys[1]);
  const bool both = faults.left_sign && faults.right_sign;
  return {"sign", which + (both ? " count" : " counts") + " backwards" + seen,
          side_lines(o, faults)};
}

WheelHint swap_hint(const OdometrySettings& o, const SideFaults& faults, const std::string& seen) {
  return {"swapped", "left and right wheel are swapped: " + seen, side_lines(o, faults)};
}

WheelHint track_hint(const OdometrySettings& o, double times, const std::string& seen) {
  const double track = o.wheels.geometry.track_m * o.wheels.geometry.slip_factor * times;
  const double slip = track / o.wheels.geometry.track_m;
  std::vector<std::string> yaml = {"odometry:", "  track: " + short_number(track)};
  if (o.wheels.geometry.slip_factor != 1) {
    yaml[1] = "  slip_factor: " + short_number(slip);
  }
  return {"track", seen + ": the track is another, or the wheels skid (slip_factor)", yaml};
}

WheelHint silent_hint(const OdometrySettings& o, const SignalKey& key, bool changes,
                      const std::string& seen) {
  if (changes && o.wheels.model == OdometryModel::kDifferentialPositions) {
    return {"speed-as-position",
            named(key) + " always comes back to where it was, " + seen +
                ": it is a speed, and the model reads it as a position",
            {"odometry:", "  model: wheel-speeds"}};
  }
  return {"silent",
          named(key) + " stays as it is, " + seen +
              ": the name, the bits or the id are those of something else, or the drive does not "
              "report",
          {}};
}

// What the moves say of the sides, apart from how far.
std::vector<WheelHint> expected_sides(const OdometrySettings& o, Kind kind,
                                      const std::vector<SignalMove>& moves,
                                      const std::string& when) {
  const double left = moves[0].moved_m, right = moves[1].moved_m;
  SideFaults faults;
  switch (kind) {
    case Kind::kForward:
    case Kind::kBackward: {
      const double way = kind == Kind::kForward ? 1 : -1;
      faults.left_sign = left * way < 0;
      faults.right_sign = right * way < 0;
      if (!faults.left_sign && !faults.right_sign) return {};
      return {sign_hint(o, faults, when)};
    }
    case Kind::kLeft:
    case Kind::kRight: {
      const double way = kind == Kind::kLeft ? 1 : -1;
      if (left * way < 0 && right * way > 0) return {};
      if (left * way > 0 && right * way < 0) {
        faults.swapped = true;
        return {swap_hint(o, faults,
                          "each went the other's way" + when +
                              "; or both count backwards, which --expect forward tells")};
      }
      faults.left_sign = left * way > 0;
      faults.right_sign = !faults.left_sign;
      return {sign_hint(o, faults, ": both went the same way" + when)};
    }
    case Kind::kLeftWheel:
    case Kind::kRightWheel:
      break;
  }
  const bool left_turned = std::abs(left) > std::abs(right);
  faults.swapped = left_turned != (kind == Kind::kLeftWheel);
  (left_turned ? faults.left_sign : faults.right_sign) = (left_turned ? left : right) < 0;
  std::vector<WheelHint> hints;
  if (faults.swapped) {
    hints.push_back(swap_hint(o, faults, named(moves[left_turned ? 0 : 1].key) + " went" + when));
  }
  if (faults.left_sign || faults.right_sign) hints.push_back(sign_hint(o, faults, when));
  return hints;
}

// By how much the moves of two sides differ from an amount that was measured.
std::vector<WheelHint> expected_amount(const Settings& settings, const ExpectedMotion& expected,
                                       const std::vector<SignalMove>& moves) {
  const OdometrySettings& o = settings.odometry;
  const double left = std::abs(moves[0].moved_m), right = std::abs(moves[1].moved_m);
  const WheelGeometry& geometry = o.wheels.geometry;
  switch (expected.kind) {
    case Kind::kForward:
    case Kind::kBackward: {
      const double way = (left + right) / 2;
      const double times = way / *expected.amount;
      if (std::abs(times - 1) <= kMostOff) return {};
      return {scale_hint(settings, times,
                         "the wheels report " + short_number(way) + " m of " +
                             short_number(*expected.amount) + " m")};
    }
    case Kind::kLeft:
    case Kind::kRight: {
      const double turn = (left + right) / (geometry.track_m * geometry.slip_factor) * 180 / kPi;
      const double times = turn / *expected.amount;
      if (std::abs(times - 1) <= kMostOff) return {};
      return {track_hint(o, times,
                         "the wheels report a turn of " + short_number(turn) + " of " +
                             short_number(*expected.amount) + " degrees")};
    }
    case Kind::kLeftWheel:
    case Kind::kRightWheel:
      break;
  }
  const double way = std::max(left, right);
  const double true_way = *expected.amount * 2 * kPi * o.wheel_radius_m;
  const double times = way / true_way;
  if (std::abs(times - 1) <= kMostOff) return {};
  return {scale_hint(settings, times,
                     "the wheel reports " + short_number(way) + " m of " + short_number(true_way) +
                         " m (" + short_number(*expected.amount) + " turns at wheel_radius " +
                         short_number(o.wheel_radius_m) + ")")};
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

std::vector<WheelHint> expectation_hints(const Settings& settings, const ExpectedMotion& expected,
                                         const std::vector<SignalMove>& moves) {
  const OdometrySettings& o = settings.odometry;
  const OdometryModel model = o.wheels.model;
  const std::string when = " (expected: " + instruction_text(expected) + ")";
  const bool one_wheel = expected.kind == Kind::kLeftWheel || expected.kind == Kind::kRightWheel;
  std::vector<WheelHint> hints;
  bool any = false;
  for (const SignalMove& move : moves) any = any || move.moved;
  std::vector<std::string> wrong;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const int sign = expected_sign(model, expected.kind, i);
    if (sign == 0) continue;
    if (!moves[i].moved && !(one_wheel && any)) {
      hints.push_back(
          {"silent",
           named(moves[i].key) + (moves[i].seen ? " did not move" : " never came") + when,
           {}});
    } else if (moves[i].moved_m * sign < 0) {
      wrong.push_back(moves[i].key.key);
    }
  }
  if (!hints.empty()) return hints;
  if (has_sides(model)) {
    hints = expected_sides(o, expected.kind, moves, when);
    if (expected.amount) {
      for (WheelHint& hint : expected_amount(settings, expected, moves)) {
        hints.push_back(std::move(hint));
      }
    }
    return hints;
  }
  if (!wrong.empty()) {
    std::string text;
    for (const std::string& key : wrong) text += (text.empty() ? "odometry." : ", odometry.") + key;
    hints.push_back(
        {"sign", text + " counts backwards" + when, {"odometry:", inverted_too(o, wrong)}});
  }
  if (!expected.amount) return hints;
  const bool turn = expected.kind == Kind::kLeft || expected.kind == Kind::kRight;
  if (model == OdometryModel::kTwist) {
    const double true_amount = turn ? *expected.amount * kPi / 180 : *expected.amount;
    const double times = std::abs(moves[turn ? 1 : 0].moved_m) / true_amount;
    if (std::abs(times - 1) > kMostOff) {
      hints.push_back(twist_hint(
          settings, turn, times,
          named(moves[turn ? 1 : 0].key) + " reports " + times_text(times) + " what was done"));
    }
  } else if (!turn) {
    double way = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < moves.size(); ++i) {
      if (expected_sign(model, expected.kind, i) == 0) continue;
      way += std::abs(moves[i].moved_m);
      ++count;
    }
    if (count == 0) return hints;
    const double times = way / static_cast<double>(count) / *expected.amount;
    if (std::abs(times - 1) > kMostOff) {
      hints.push_back(
          scale_hint(settings, times, "the wheels report " + times_text(times) + " what was done"));
    }
  }
  return hints;
}

}  // namespace zonepack
