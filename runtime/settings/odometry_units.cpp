// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/odometry_units.hpp"

#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

// A unit of the DBC file against what odometry reads; `expected` names examples.
Outcome<DbcUnit> usable_unit(const std::string& text, DbcUnit::Kind kind, bool per_time,
                             const std::string& expected) {
  const DbcUnit unit = parse_dbc_unit(text);
  const bool ticks = unit.kind == DbcUnit::Kind::kTicks;
  if (unit.kind == DbcUnit::Kind::kNone) return unit;
  if (unit.kind == kind && (ticks || unit.per_time == per_time)) return unit;
  return failure("the DBC file gives this signal the unit \"" + text + "\"; expected " + expected +
                 " (or no unit). Correct the DBC file, or write the signal out in can.signals");
}

// One percent in units of `odometry`.
Outcome<double> percent_of_full_scale(const OdometrySettings& odometry, const std::string& text) {
  if (odometry.full_scale > 0) return odometry.full_scale / 100;
  return failure("the DBC file gives this signal in \"" + text +
                 "\"; give odometry.full_scale: what 100 % is, in odometry.unit");
}

}  // namespace

DbcUnit as_dbc_unit(WheelUnit unit) {
  using Kind = DbcUnit::Kind;
  switch (unit) {
    case WheelUnit::kMetres:
      return {Kind::kLength, 1};
    case WheelUnit::kMillimetres:
      return {Kind::kLength, 0.001};
    case WheelUnit::kKilometresPerHour:
      return {Kind::kLength, 1000.0 / 3600};
    case WheelUnit::kRadians:
      return {Kind::kAngle, 1};
    case WheelUnit::kDegrees:
      return {Kind::kAngle, kDegree_rad};
    case WheelUnit::kTurns:
      return {Kind::kAngle, kTurn_rad};
    case WheelUnit::kRpm:
    case WheelUnit::kErpm:
      return {Kind::kAngle, kTurn_rad / 60};
    case WheelUnit::kTicks:
      break;
  }
  return {Kind::kTicks, 1};
}

bool is_percent(const std::string& text) {
  const DbcUnit unit = parse_dbc_unit(text);
  return unit.kind == DbcUnit::Kind::kPercent && !unit.per_time;
}

Outcome<double> wheel_conversion(const OdometrySettings& odometry, const std::string& text) {
  if (is_percent(text)) return percent_of_full_scale(odometry, text);
  const bool speeds = !reads_positions(odometry.wheels.model);
  const DbcUnit wanted = as_dbc_unit(odometry.unit);
  std::string expected = "ticks";
  if (wanted.kind == DbcUnit::Kind::kLength) {
    expected = speeds ? "a speed such as m/s, km/h, mm/s or mph" : "a length such as m or mm";
  } else if (wanted.kind == DbcUnit::Kind::kAngle) {
    expected = speeds ? "a speed of rotation such as rad/s, deg/s or rpm"
                      : "an angle such as rad, deg or turns";
  }
  const auto unit = usable_unit(text, wanted.kind, speeds, expected + ", by odometry.unit");
  if (!unit && !speeds && usable_unit(text, wanted.kind, true, expected)) {
    return failure(unit.error().message + "; or, since this is a speed, write model: wheel-speeds");
  }
  if (!unit) return unit.error();
  // Makers write rpm for electrical turns too.
  if (unit->kind == DbcUnit::Kind::kNone || odometry.unit == WheelUnit::kErpm) return 1.0;
  return unit->si == wanted.si ? 1.0 : unit->si / wanted.si;
}

Outcome<double> si_of(const OdometrySettings& odometry, const std::string& key,
                      const std::string& text) {
  const bool forward = key == "forward";
  const double forward_si = is_length(odometry.unit) ? as_dbc_unit(odometry.unit).si : 1.0;
  if (forward && is_percent(text)) {
    const auto percent = percent_of_full_scale(odometry, text);
    return percent ? Outcome<double>(*percent * forward_si) : percent;
  }
  const auto unit =
      forward ? usable_unit(text, DbcUnit::Kind::kLength, true, "m/s, km/h, mm/s or mph")
      : key == "steering"
          ? usable_unit(text, DbcUnit::Kind::kAngle, false, "an angle such as rad or deg")
          : usable_unit(text, DbcUnit::Kind::kAngle, true, "a yaw rate such as rad/s or deg/s");
  if (!unit) return unit.error();
  if (unit->kind != DbcUnit::Kind::kNone) return unit->si;
  if (forward) return forward_si;
  return odometry.angle_unit == AngleUnit::kDegrees ? kDegree_rad : 1.0;
}

double metres_per_unit(const OdometrySettings& odometry) {
  double metres = odometry.scale;
  if (odometry.unit == WheelUnit::kMetres) return metres;
  if (is_length(odometry.unit)) return metres * as_dbc_unit(odometry.unit).si;
  metres *= odometry.wheel_radius_m;
  if (odometry.unit == WheelUnit::kDegrees) return metres * kDegree_rad / odometry.gear;
  if (odometry.unit != WheelUnit::kRadians) metres *= 2 * kPi;
  if (odometry.unit == WheelUnit::kRpm || odometry.unit == WheelUnit::kErpm) metres /= 60;
  if (odometry.unit == WheelUnit::kErpm) metres /= odometry.pole_pairs;
  if (odometry.unit == WheelUnit::kTicks) metres /= odometry.ticks_per_turn;
  return metres / odometry.gear;
}

}  // namespace zonepack
