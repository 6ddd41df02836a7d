// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/wheel_hints.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"
#include "runtime/calibrate/expectation_hints.hpp"
#include "runtime/calibrate/scale_guess.hpp"
#include "runtime/calibrate/side_faults.hpp"
#include "runtime/calibrate/side_hints.hpp"

namespace zonepack {
namespace {

bool is_twist(OdometryModel model) { return model == OdometryModel::kTwist; }

// The model with positions instead of speeds, or the other way round; nothing for a twist.
const char* other_reading(OdometryModel model) {
  switch (model) {
    case OdometryModel::kDifferentialPositions:
      return "wheel-speeds";
    case OdometryModel::kWheelSpeeds:
      return "differential-positions";
    case OdometryModel::kAckermannPositions:
      return "ackermann-speeds";
    case OdometryModel::kAckermannSpeeds:
      return "ackermann-positions";
    case OdometryModel::kMecanumPositions:
      return "mecanum-speeds";
    case OdometryModel::kMecanumSpeeds:
      return "mecanum-positions";
    case OdometryModel::kOmniPositions:
      return "omni-speeds";
    case OdometryModel::kOmniSpeeds:
      return "omni-positions";
    case OdometryModel::kTwist:
      break;
  }
  return nullptr;
}

// The other of "left" and "right" inside a name, in the same letters; empty when it has neither.
std::string other_side(std::string name) {
  constexpr std::pair<const char*, const char*> kPairs[] = {{"left", "right"}, {"Left", "Right"},
                                                            {"LEFT", "RIGHT"}, {"right", "left"},
                                                            {"Right", "Left"}, {"RIGHT", "LEFT"}};
  for (const auto& [from, to] : kPairs) {
    const std::size_t at = name.find(from);
    if (at != std::string::npos) return name.replace(at, std::string(from).size(), to);
  }
  return {};
}

// Two keys that name the same bits of the same frames.
std::optional<WheelHint> same_signal(const OdometrySettings& odometry) {
  const auto keys = signal_keys(odometry);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t j = i + 1; j < keys.size(); ++j) {
      if (!(odometry.wheels.signals[i] == odometry.wheels.signals[j])) continue;
      const bool right_is_wrong = keys[i].key != "left" || keys[i].name != other_side(keys[i].name);
      const SignalKey& wrong = right_is_wrong ? keys[j] : keys[i];
      const std::string other = other_side(keys[i].name);
      return WheelHint{
          "same-signal",
          named(keys[i]) + " and " + named(keys[j]) +
              " are the same bits of the same frame, so that no turn can be seen",
          {"odometry:", "  " + wrong.key + ": " +
                            (other.empty() ? "NAME  # of the signal of that wheel" : other)}};
    }
  }
  return std::nullopt;
}

// A counter that is read as a speed.
std::optional<WheelHint> counter_hint(const Settings& settings, const WheelEvidence& evidence) {
  const OdometrySettings& o = settings.odometry;
  const auto keys = signal_keys(o);
  const char* const model = other_reading(o.wheels.model);
  if (model == nullptr || reads_positions(o.wheels.model)) return std::nullopt;
  const std::size_t wheels = WheelModel(o.wheels.model, o.wheels.geometry).wheels();
  constexpr double kLongest_s = 20;  // no robot speeds up for longer
  for (std::size_t i = 0; i < std::min({wheels, keys.size(), evidence.traces.size()}); ++i) {
    const SignalTrace& trace = evidence.traces[i];
    if (!trace.only_counts()) continue;
    const double most = std::max(std::abs(trace.least()), std::abs(trace.most())) *
                        std::abs(o.wheels.metres_per_unit[i]);
    if (most <= o.wheels.max_speed_m_s && trace.seconds() < kLongest_s) continue;
    return WheelHint{"counter-as-speed",
                     named(keys[i]) + " only " +
                         (trace.rises() * 2 > trace.changes() ? "rises" : "falls") + " (" +
                         std::to_string(trace.changes()) + " changes in " +
                         decimals_text(trace.seconds(), 0) +
                         " s): it is a counter, and the model reads it as a speed",
                     {"odometry:", std::string("  model: ") + model}};
  }
  return std::nullopt;
}

// Two wheels that only ever turn against each other, when nothing says what the robot did.
std::optional<WheelHint> opposite(const Settings& settings, const WheelEvidence& evidence) {
  constexpr double kLeastWay_m = 5;
  constexpr double kUnequal = 0.1;
  const OdometrySettings& o = settings.odometry;
  if (!evidence.windows.empty() || evidence.traces.size() != 2) return std::nullopt;
  const double left = evidence.traces[0].moved() * o.wheels.metres_per_unit[0];
  const double right = evidence.traces[1].moved() * o.wheels.metres_per_unit[1];
  const double least = std::min(std::abs(left), std::abs(right));
  if (least < kLeastWay_m || std::abs(left + right) > kUnequal * least) return std::nullopt;
  const std::string wrong = left < 0 ? "left" : "right";
  return WheelHint{"sign",
                   "left and right went opposite ways, " + decimals_text(left, 1) + " and " +
                       decimals_text(right, 1) +
                       " m: unless the robot only turned on the spot, one counts backwards; if it "
                       "drove forward, it is odometry." +
                       wrong,
                   {"odometry:", inverted_too(o, {wrong})}};
}

std::optional<WheelHint> too_fast(const Settings& settings, const WheelEvidence& evidence) {
  constexpr std::uint64_t kLeastSamples = 20;
  if (evidence.samples < kLeastSamples || evidence.too_fast * 2 < evidence.samples) {
    return std::nullopt;
  }
  const double speed = evidence.usual_speed_m_s;
  const double most = settings.odometry.wheels.max_speed_m_s;
  if (!(speed > most)) return std::nullopt;
  return too_fast_hint(settings, speed,
                       std::to_string(evidence.too_fast) + " of " +
                           std::to_string(evidence.samples) +
                           " samples are refused as too fast, usually at " + short_number(speed) +
                           " m/s where odometry.max_speed is " + short_number(most));
}

// What the signals did against what somebody did with the robot, one signal after the other.
std::vector<WheelHint> against_expectation(const Settings& settings,
                                           const WheelEvidence& evidence) {
  const OdometrySettings& o = settings.odometry;
  const auto keys = signal_keys(o);
  if (evidence.traces.size() < keys.size()) return {};
  std::vector<SignalMove> moves;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const SignalTrace& trace = evidence.traces[i];
    const double unit = o.wheels.metres_per_unit[i];
    SignalMove move{keys[i], trace.moved() * unit, trace.changes() > 0, trace.count() > 0};
    // A last digit that flickers is no motion.
    const bool counter = reads_positions(o.wheels.model) && trace.integer();
    constexpr double kLeastSteps = 3;
    if (counter && std::abs(trace.moved()) < kLeastSteps * std::abs(trace.signal().factor)) {
      move.moved = false;
    }
    moves.push_back(move);
  }
  return expectation_hints(settings, *evidence.expected, moves);
}

}  // namespace

bool has_sides(OdometryModel model) noexcept {
  return model == OdometryModel::kDifferentialPositions || model == OdometryModel::kWheelSpeeds;
}

WheelOdometrySettings without_limits(const WheelOdometrySettings& settings) {
  WheelOdometrySettings open = settings;
  open.max_speed_m_s = open.max_yaw_rate_rad_s = open.max_acceleration_m_s2 =
      std::numeric_limits<double>::max();
  return open;
}

std::vector<WheelHint> wheel_hints(const Settings& settings, const WheelEvidence& evidence) {
  std::vector<WheelHint> hints;
  // Nothing that is measured means anything while these hold.
  if (auto same = same_signal(settings.odometry)) return {*same};
  if (auto counter = counter_hint(settings, evidence)) return {*counter};
  if (evidence.expected) {
    hints = against_expectation(settings, evidence);
  } else if (has_sides(settings.odometry.wheels.model)) {
    hints = side_hints(settings, evidence);
    if (auto against = opposite(settings, evidence)) hints.push_back(*against);
  } else if (is_twist(settings.odometry.wheels.model)) {
    hints = twist_hints(settings, evidence);
  }
  const bool explained = std::any_of(hints.begin(), hints.end(), [](const WheelHint& hint) {
    return hint.kind != "sign" && hint.kind != "swapped" && hint.kind != "track";
  });
  if (auto fast = too_fast(settings, evidence); fast && !explained) hints.push_back(*fast);
  return hints;
}

std::string hint_text(const WheelHint& hint) {
  std::string text = "hint: " + hint.text + (hint.yaml.empty() ? "\n" : "; write\n");
  for (const std::string& line : hint.yaml) text += "    " + line + "\n";
  return text;
}

std::string hints_json(const std::vector<WheelHint>& hints) {
  std::string text = "[";
  for (const WheelHint& hint : hints) {
    std::string yaml;
    for (const std::string& line : hint.yaml) yaml += line + "\n";
    text += (text.size() > 1 ? ", " : "") + std::string("{\"kind\": ") + json_quoted(hint.kind) +
            ", \"text\": " + json_quoted(hint.text) + ", \"yaml\": " + json_quoted(yaml) + "}";
  }
  return text + "]";
}

}  // namespace zonepack
