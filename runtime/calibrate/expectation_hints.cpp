// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/expectation_hints.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/base/number_text.hpp"
#include "runtime/calibrate/scale_guess.hpp"
#include "runtime/calibrate/side_faults.hpp"
#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

using MotionKind = ExpectedMotion::Kind;

constexpr double kMostOff = 0.05;  // of a motion that was measured with a tape

// What the moves say of the sides, apart from how far.
std::vector<WheelHint> expected_sides(const OdometrySettings& o, MotionKind kind,
                                      const std::vector<SignalMove>& moves,
                                      const std::string& when) {
  const double left = moves[0].moved_m, right = moves[1].moved_m;
  SideFaults faults;
  switch (kind) {
    case MotionKind::kForward:
    case MotionKind::kBackward: {
      const double way = kind == MotionKind::kForward ? 1 : -1;
      faults.left_sign = left * way < 0;
      faults.right_sign = right * way < 0;
      if (!faults.left_sign && !faults.right_sign) return {};
      return {sign_hint(o, faults, when)};
    }
    case MotionKind::kLeft:
    case MotionKind::kRight: {
      const double way = kind == MotionKind::kLeft ? 1 : -1;
      if (left * way < 0 && right * way > 0) return {};
      if (left * way > 0 && right * way < 0) {
        faults.swapped = true;
        return {swap_hint(o, faults,
                          "each went the other's way" + when +
                              "; or both count backwards: drive forward with --expect forward to "
                              "find out")};
      }
      faults.left_sign = left * way > 0;
      faults.right_sign = !faults.left_sign;
      return {sign_hint(o, faults, ": both went the same way" + when)};
    }
    case MotionKind::kLeftWheel:
    case MotionKind::kRightWheel:
      break;
  }
  const bool left_turned = std::abs(left) > std::abs(right);
  faults.swapped = left_turned != (kind == MotionKind::kLeftWheel);
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
    case MotionKind::kForward:
    case MotionKind::kBackward: {
      const double way = (left + right) / 2;
      const double times = way / *expected.amount;
      if (std::abs(times - 1) <= kMostOff) return {};
      return {scale_hint(settings, times,
                         "the wheels report " + short_number(way) + " m of " +
                             short_number(*expected.amount) + " m")};
    }
    case MotionKind::kLeft:
    case MotionKind::kRight: {
      const double turn = (left + right) / (geometry.track_m * geometry.slip_factor) * 180 / kPi;
      const double times = turn / *expected.amount;
      if (std::abs(times - 1) <= kMostOff) return {};
      return {track_hint(o, times,
                         "the wheels report a turn of " + short_number(turn) + " of " +
                             short_number(*expected.amount) + " degrees")};
    }
    case MotionKind::kLeftWheel:
    case MotionKind::kRightWheel:
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

}  // namespace

std::vector<WheelHint> expectation_hints(const Settings& settings, const ExpectedMotion& expected,
                                         const std::vector<SignalMove>& moves) {
  const OdometrySettings& o = settings.odometry;
  const OdometryModel model = o.wheels.model;
  const std::string when = " (expected: " + instruction_text(expected) + ")";
  const bool one_wheel =
      expected.kind == MotionKind::kLeftWheel || expected.kind == MotionKind::kRightWheel;
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
  const bool turn = expected.kind == MotionKind::kLeft || expected.kind == MotionKind::kRight;
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
