// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/scale_guess.hpp"

#include <algorithm>
#include <cmath>

#include "platform/base/number_text.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/dbc_file.hpp"
#include "runtime/settings/field.hpp"

namespace zonepack {
namespace {

constexpr double kTolerance = 0.04;  // tyres, tapes and slip
constexpr const char* kOdometry = "odometry:";

bool near(double value, double expected) {
  return std::abs(value - expected) <= kTolerance * std::abs(expected);
}

const char* word_of(WheelUnit unit) {
  return EnumWords<WheelUnit>::kWords[static_cast<std::size_t>(unit)];
}

// What makes a unit that of a speed, where its word does not say it.
std::string rate_word(OdometryModel model, WheelUnit unit) {
  const bool rate =
      unit == WheelUnit::kRpm || unit == WheelUnit::kErpm || unit == WheelUnit::kKilometresPerHour;
  return rate || reads_positions(model) ? "" : " a second";
}

std::string line(const char* key, const std::string& value) {
  return "  " + std::string(key) + ": " + value;
}

bool from_dbc(const Settings& settings, const std::string& name) {
  return !settings.can.dbc.empty() && name.find('.') != std::string::npos;
}

// Whether the DBC file gives the unit, which settings cannot contradict then.
bool dbc_gives_unit(const Settings& settings) {
  const auto keys = signal_keys(settings.odometry);
  if (keys.empty() || !from_dbc(settings, keys[0].name)) return false;
  const LoadedDbc dbc = parse_dbc(settings.can.dbc_text, settings.can.dbc);
  const auto found = dbc.file.find(keys[0].name);
  return found && !found->unit.empty();
}

// Units that the settings could name instead of the present one, the likeliest first: those that
// keep to lengths or to rotation.
std::vector<WheelUnit> other_units(const Settings& settings) {
  const OdometrySettings& o = settings.odometry;
  if (dbc_gives_unit(settings)) return {};
  std::vector<WheelUnit> units;
  for (const bool same_kind : {true, false}) {
    for (const WheelUnit unit :
         {WheelUnit::kMetres, WheelUnit::kMillimetres, WheelUnit::kKilometresPerHour,
          WheelUnit::kRadians, WheelUnit::kTurns, WheelUnit::kRpm, WheelUnit::kDegrees}) {
      const bool rate = unit == WheelUnit::kRpm || unit == WheelUnit::kKilometresPerHour;
      if (unit == o.unit || (rate && reads_positions(o.wheels.model))) continue;
      if (is_length(unit) && o.gear != 1) continue;  // the settings would contradict themselves
      if ((is_length(unit) == is_length(o.unit)) == same_kind) units.push_back(unit);
    }
  }
  return units;
}

double ratio_with(const OdometrySettings& odometry, WheelUnit unit) {
  OdometrySettings other = odometry;
  other.unit = unit;
  return metres_per_unit(other) / metres_per_unit(odometry);
}

// A factor that slips into settings, and what makes it.
struct KnownFactor {
  double times;
  const char* meaning;
};
constexpr KnownFactor kKnownFactors[] = {
    {10, "a power of ten"},
    {100, "centimetres for metres"},
    {1000, "thousandths for the whole"},
    {3.6, "km/h for m/s"},
    {60, "a minute for a second"},
    {2 * kPi, "radians for turns"},
    {180 / kPi, "degrees for radians"},
    {60 / (2 * kPi), "turns a minute for radians a second"},
    {1 / 0.3048, "feet for metres"},
    {1 / 0.0254, "inches for metres"},
};

std::optional<KnownFactor> known_factor(double times) {
  for (const KnownFactor& known : kKnownFactors) {
    if (near(times, known.times)) return known;
    if (near(times * known.times, 1)) return KnownFactor{1 / known.times, known.meaning};
  }
  return std::nullopt;
}

// The factors of the signals, `times` less.
WheelHint factor_hint(const Settings& settings, const std::vector<SignalKey>& keys, double times,
                      const std::string& seen) {
  WheelHint hint{
      "factor", seen + ": the factor of the signals is too " + (times > 1 ? "large" : "small"), {}};
  if (const auto known = known_factor(times)) {
    times = known->times;
    hint.text += " by " + short_number(times > 1 ? times : 1 / times) + " (" + known->meaning +
                 ", or the reverse)";
  }
  bool written = false;
  for (const SignalKey& key : keys) {
    const auto signal = settings.can.signals.find(key.name);
    if (from_dbc(settings, key.name) || signal == settings.can.signals.end()) continue;
    if (!written) hint.yaml = {"can:", "  signals:"};
    written = true;
    hint.yaml.push_back("    " + key.name + ":");
    hint.yaml.push_back("      factor: " + short_number(signal->second.factor / times, 6));
  }
  if (!written) {
    hint.text += "; in " + settings.can.dbc + " divide the factor of";
    for (std::size_t i = 0; i < keys.size(); ++i)
      hint.text += (i > 0 ? " and " : " ") + keys[i].name;
    hint.text += " by " + short_number(times);
  }
  return hint;
}

std::vector<SignalKey> wheel_keys(const Settings& settings) {
  auto keys = signal_keys(settings.odometry);
  const WheelOdometrySettings& wheels = settings.odometry.wheels;
  keys.resize(std::min(keys.size(), WheelModel(wheels.model, wheels.geometry).wheels()));
  return keys;
}

// Of wheels that turn: what stands between the signal and the ground.
std::optional<WheelHint> rotation_hint(const OdometrySettings& o, double times,
                                       const std::string& seen) {
  const double whole = std::round(times);
  const bool integer = whole >= 2 && near(times, whole);
  if (o.unit == WheelUnit::kTicks) {
    for (const double edges : {4.0, 2.0, 0.5, 0.25}) {
      if (!near(times, edges)) continue;
      return WheelHint{
          "ticks",
          seen + ": an encoder's lines may be counted as one, two or four edges",
          {kOdometry, line("ticks_per_turn", short_number(o.ticks_per_turn * edges, 9))}};
    }
  }
  if (o.unit == WheelUnit::kErpm && near(o.pole_pairs * times, std::round(o.pole_pairs * times)) &&
      std::round(o.pole_pairs * times) >= 1 && std::round(o.pole_pairs * times) <= 50) {
    return WheelHint{
        "gear",
        seen + ": the pole pairs of the motor are missing",
        {kOdometry, line("pole_pairs", short_number(std::round(o.pole_pairs * times)))}};
  }
  const double gear = o.gear * times;
  if (near(gear, 1) && o.gear != 1) {
    return WheelHint{"gear",
                     seen + ": the signals are of the wheels already, after the gear",
                     {kOdometry, line("gear", "1")}};
  }
  if (times >= 1.8 || (o.gear != 1 && gear >= 1 && (times < 0.55 || times > 1.8))) {
    std::string text = seen + ": the signals are those of the motor, before the gear";
    if (o.unit == WheelUnit::kRpm && integer) {
      text +=
          "; or they are electrical turns (unit: erpm, pole_pairs: " + short_number(whole) + ")";
    }
    const double value = near(gear, std::round(gear)) ? std::round(gear) : gear;
    return WheelHint{"gear", text, {kOdometry, line("gear", short_number(value))}};
  }
  constexpr double kLeastRadius_m = 0.02, kMostRadius_m = 1;
  const double radius = o.wheel_radius_m / times;
  if (radius < kLeastRadius_m || radius > kMostRadius_m) {
    return WheelHint{"gear",
                     seen + ": the wheel turns more than the signals say",
                     {kOdometry, line("gear", short_number(gear))}};
  }
  return WheelHint{"radius",
                   seen + ": the wheels are of another size",
                   {kOdometry, line("wheel_radius", short_number(radius))}};
}

}  // namespace

WheelHint scale_hint(const Settings& settings, double times, const std::string& seen) {
  const OdometrySettings& o = settings.odometry;
  for (const WheelUnit unit : other_units(settings)) {
    // Of rotation that counts too much, a gear is likelier than a length that fits by chance.
    if (is_length(unit) && !is_length(o.unit) && times > 1) continue;
    if (!near(times * ratio_with(o, unit), 1)) continue;
    std::string text = seen + ": the signals are in " + word_of(unit) +
                       (rate_word(o.wheels.model, unit)) + ", not in " + word_of(o.unit) +
                       rate_word(o.wheels.model, o.unit);
    const double whole = std::round(times);
    if (!is_length(o.unit) && o.gear == 1 && whole >= 2 && near(times, whole)) {
      text += " (or gear: " + short_number(whole) + ", if they are the motor's)";
    }
    std::vector<std::string> yaml = {kOdometry, line("unit", word_of(unit))};
    if (is_length(o.unit) && !is_length(unit)) {
      yaml.push_back(line("wheel_radius", short_number(o.wheel_radius_m)));
    }
    return {"unit", text, yaml};
  }
  if (!is_length(o.unit)) {
    if (auto hint = rotation_hint(o, times, seen)) return *hint;
  }
  constexpr double kMostScale = 2;  // config/SETTINGS.md
  const double scale = o.scale / times;
  if (scale >= 1 / kMostScale && scale <= kMostScale) {
    return {"scale", seen, {kOdometry, line("scale", short_number(scale))}};
  }
  return factor_hint(settings, wheel_keys(settings), times, seen);
}

WheelHint too_fast_hint(const Settings& settings, double usual_speed_m_s, const std::string& seen) {
  const OdometrySettings& o = settings.odometry;
  const double most = o.wheels.max_speed_m_s;
  constexpr double kSlowest = 0.05;  // of max_speed, that a robot usually drives at
  for (const WheelUnit unit : other_units(settings)) {
    const double speed = usual_speed_m_s * ratio_with(o, unit);
    if (is_length(unit) != is_length(o.unit) || speed > most || speed < kSlowest * most) continue;
    return {"too-fast",
            seen + ": the signals may be in " + word_of(unit) + rate_word(o.wheels.model, unit) +
                (is_length(o.unit) ? "" : ", or a gear is missing"),
            {kOdometry, line("unit", word_of(unit))}};
  }
  if (!is_length(o.unit)) {
    return {"too-fast",
            seen +
                ": a gear is missing, or its value is too small; what stands on the gearbox is "
                "right, at least",
            {kOdometry, line("gear", short_number(std::ceil(o.gear * usual_speed_m_s / most)))}};
  }
  if (usual_speed_m_s < 3 * most) {
    return {"too-fast",
            seen + ": if the robot is as fast as that, allow it",
            {kOdometry, line("max_speed", short_number(std::ceil(usual_speed_m_s * 1.2)))}};
  }
  const double tens = std::pow(10, std::ceil(std::log10(usual_speed_m_s / most)));
  return factor_hint(settings, wheel_keys(settings), tens, seen);
}

WheelHint twist_hint(const Settings& settings, bool yaw, double times, const std::string& seen) {
  const OdometrySettings& o = settings.odometry;
  const auto keys = signal_keys(o);
  const std::size_t index = yaw ? 1 : 0;
  const bool fixed = from_dbc(settings, keys[index].name) && dbc_gives_unit(settings);
  if (yaw && !fixed && o.angle_unit == AngleUnit::kRadians && near(times, 180 / kPi)) {
    return {"unit",
            seen + ": the yaw rate is in degrees a second",
            {kOdometry, line("angle_unit", "degrees")}};
  }
  if (yaw && !fixed && o.angle_unit == AngleUnit::kDegrees && near(times, kPi / 180)) {
    return {"unit",
            seen + ": the yaw rate is in radians a second",
            {kOdometry, line("angle_unit", "radians")}};
  }
  for (const WheelUnit unit : other_units(settings)) {
    if (yaw || fixed || !is_length(unit) || !near(times * ratio_with(o, unit), 1)) continue;
    return {"unit",
            seen + ": the speed is in " + word_of(unit) + rate_word(o.wheels.model, unit),
            {kOdometry, line("unit", word_of(unit))}};
  }
  return factor_hint(settings, {keys[index]}, times, seen);
}

}  // namespace zonepack
