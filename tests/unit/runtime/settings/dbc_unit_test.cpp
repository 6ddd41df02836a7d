// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_unit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = DbcUnit::Kind;

TEST(DbcUnit, KnowsTheSpellingsOfPublicFiles) {
  struct Case {
    const char* text;
    Kind kind;
    double si;
    bool per_time;
  };
  const double degree = 0.017453292519943295;  // pi / 180
  const double rpm = 0.10471975511965977;      // 2 pi / 60
  for (const Case& c : {
           Case{"m/s", Kind::kLength, 1, true},
           Case{"km/h", Kind::kLength, 1 / 3.6, true},
           Case{"Km/H", Kind::kLength, 1 / 3.6, true},
           Case{"kph", Kind::kLength, 1 / 3.6, true},
           Case{"km/hr", Kind::kLength, 1 / 3.6, true},
           Case{"mm/s", Kind::kLength, 0.001, true},
           Case{"mm / sec", Kind::kLength, 0.001, true},
           Case{"mph", Kind::kLength, 0.44704, true},
           Case{"ft/s", Kind::kLength, 0.3048, true},
           Case{"metres", Kind::kLength, 1, false},
           Case{"mm", Kind::kLength, 0.001, false},
           Case{"rad", Kind::kAngle, 1, false},
           Case{"deg", Kind::kAngle, degree, false},
           Case{"degrees", Kind::kAngle, degree, false},
           Case{"\xC2\xB0", Kind::kAngle, degree, false},
           Case{"\xB0/s", Kind::kAngle, degree, true},
           Case{"Deg/Sec", Kind::kAngle, degree, true},
           Case{"degrees per second", Kind::kAngle, degree, true},
           Case{"rpm", Kind::kAngle, rpm, true},
           Case{"1/min", Kind::kAngle, rpm, true},
           Case{"min^-1", Kind::kAngle, rpm, true},
           Case{"U/min", Kind::kAngle, rpm, true},
           Case{"rev/min", Kind::kAngle, rpm, true},
           Case{"ticks", Kind::kTicks, 1, false},
           Case{"counts/s", Kind::kTicks, 1, true},
           Case{"", Kind::kNone, 1, false},
           Case{"-", Kind::kNone, 1, false},
           Case{"%", Kind::kPercent, 0.01, false},
           Case{"Percent", Kind::kPercent, 0.01, false},
           Case{"Nm", Kind::kUnknown, 1, false},
           Case{"m/s^2", Kind::kUnknown, 1, false},
           Case{"\xC2\xB0"
                "C",
                Kind::kUnknown, 1, false},
       }) {
    const DbcUnit unit = parse_dbc_unit(c.text);
    EXPECT_EQ(unit.kind, c.kind) << c.text;
    EXPECT_DOUBLE_EQ(unit.si, c.si) << c.text;
    EXPECT_EQ(unit.per_time, c.per_time) << c.text;
  }
}

// Settings whose signals all have the unit; `odometry` names model and keys.
LoadedSettings with_unit(const std::string& unit, const std::string& odometry) {
  const std::string dbc = "BO_ 291 W: 4 A\n SG_ L : 0|16@1- (0.01,0) [0|0] \"" + unit +
                          "\" A\n SG_ R : 16|16@1- (0.01,0) [0|0] \"" + unit + "\" A\n";
  return parse_settings("can: {dbc: robot.dbc}\nodometry: {" + odometry + "}\n", "robot.yaml", dbc);
}

double metres_of(const LoadedSettings& loaded, std::size_t signal = 0) {
  EXPECT_THAT(loaded.faults, IsEmpty());
  return loaded.settings.odometry.wheels.metres_per_unit[signal];
}

const std::string kSpeeds = "model: wheel-speeds, left: W.L, right: W.R";
const std::string kPositions = "model: differential-positions, left: W.L, right: W.R";

TEST(DbcUnit, OfWheelsIsConverted) {
  EXPECT_EQ(metres_of(with_unit("m/s", kSpeeds)), 1);
  EXPECT_EQ(metres_of(with_unit("", kSpeeds)), 1);
  EXPECT_DOUBLE_EQ(metres_of(with_unit("km/h", kSpeeds)), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(with_unit("km/h", kSpeeds + ", unit: metres"), 1), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(with_unit("", kSpeeds + ", unit: km/h")), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(with_unit("km/h", kSpeeds + ", unit: km/h")), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(with_unit("mm", kPositions)), 0.001);
  EXPECT_DOUBLE_EQ(metres_of(with_unit("", kPositions + ", unit: mm")), 0.001);
  // 60 rpm of a wheel of 0.5 m radius: pi m/s.
  EXPECT_DOUBLE_EQ(60 * metres_of(with_unit("rpm", kSpeeds + ", wheel_radius: 0.5")),
                   3.141592653589793);
  // A motor that turns 10 times as fast: 180 deg/s of it are 18 deg/s of the wheel, pi / 20 m/s.
  EXPECT_DOUBLE_EQ(
      180 * metres_of(with_unit("deg/s", kSpeeds + ", unit: rpm, gear: 10, wheel_radius: 0.5")),
      3.141592653589793 / 20);
  // 50 % of 1.6 m/s are 0.8 m/s; of 3.6 km/h, half a metre a second.
  EXPECT_DOUBLE_EQ(50 * metres_of(with_unit("%", kSpeeds + ", full_scale: 1.6")), 0.8);
  EXPECT_DOUBLE_EQ(50 * metres_of(with_unit("Percent", kSpeeds + ", unit: km/h, full_scale: 3.6")),
                   0.5);
  EXPECT_DOUBLE_EQ(360 * metres_of(with_unit("", kPositions + ", unit: degrees, wheel_radius: 1")),
                   2 * 3.141592653589793);
}

TEST(DbcUnit, ThatContradictsTheSettingsIsRefusedByName) {
  const auto fault = [](const std::string& unit, const std::string& odometry) {
    const LoadedSettings loaded = with_unit(unit, odometry);
    return loaded.ok() ? std::string() : loaded.faults.front();
  };
  EXPECT_THAT(fault("Nm", kSpeeds),
              HasSubstr("robot.yaml:2: odometry.left: \"W.L\": the DBC file gives this signal the "
                        "unit \"Nm\"; expected a speed such as m/s, km/h"));
  EXPECT_THAT(fault("%", kSpeeds), HasSubstr("\"%\"; give odometry.full_scale: what 100 % is"));
  EXPECT_THAT(fault("%/s", kSpeeds), HasSubstr("the unit \"%/s\""));
  EXPECT_THAT(fault("m/s", kSpeeds + ", full_scale: 2"), HasSubstr("full_scale: has no effect"));
  EXPECT_THAT(fault("m", kSpeeds), HasSubstr("the unit \"m\"; expected a speed"));
  EXPECT_THAT(fault("km/h", kPositions), AllOf(HasSubstr("expected a length such as m or mm"),
                                               HasSubstr("a speed, write model: wheel-speeds")));
  EXPECT_THAT(fault("rpm", kSpeeds + ", unit: metres"), HasSubstr("the unit \"rpm\""));
  EXPECT_THAT(fault("m/s", kSpeeds + ", unit: rpm"), HasSubstr("rad/s, deg/s or rpm"));
  EXPECT_THAT(fault("rpm", kSpeeds), HasSubstr("odometry.wheel_radius: missing; the DBC file"));
  EXPECT_THAT(fault("ticks", kPositions), HasSubstr("odometry.unit: missing; the DBC file counts"));
  EXPECT_THAT(fault("", kPositions + ", unit: km/h"), HasSubstr("km/h is a speed"));
}

TEST(DbcUnit, OfTwistAndSteeringIsConverted) {
  const auto twist = [](const std::string& forward, const std::string& yaw_rate,
                        const std::string& more = "") {
    return parse_settings(
        "can: {dbc: r.dbc}\nodometry: {model: twist, forward: T.V, yaw_rate: T.W" + more + "}\n",
        "robot.yaml",
        "BO_ 1 T: 4 A\n SG_ V : 0|16@1- (1,0) [0|0] \"" + forward +
            "\" A\n SG_ W : 16|16@1- (1,0) [0|0] \"" + yaw_rate + "\" A\n");
  };
  EXPECT_DOUBLE_EQ(metres_of(twist("km/h", "deg/s"), 0), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(twist("km/h", "deg/s"), 1), 0.017453292519943295);
  EXPECT_DOUBLE_EQ(metres_of(twist("", "", ", unit: km/h, angle_unit: degrees"), 0), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(twist("", "", ", angle_unit: degrees"), 1), 0.017453292519943295);
  EXPECT_EQ(metres_of(twist("m/s", "rad/s"), 1), 1);
  EXPECT_THAT(twist("m/s", "deg").faults, ElementsAre(HasSubstr("a yaw rate such as rad/s")));

  const LoadedSettings car = parse_settings(
      "can: {dbc: r.dbc}\nodometry: {model: ackermann-speeds, forward: T.V, steering: T.W}\n",
      "robot.yaml",
      "BO_ 1 T: 4 A\n SG_ V : 0|16@1- (1,0) [0|0] \"km/h\" A\n SG_ W : 16|16@1- (1,0) [0|0] "
      "\"deg\" A\n");
  EXPECT_DOUBLE_EQ(metres_of(car, 0), 1 / 3.6);
  EXPECT_DOUBLE_EQ(metres_of(car, 1), 0.017453292519943295);
}

TEST(DbcUnit, ASlipInTheDbcFileIsAWarningOfTheSettings) {
  const LoadedSettings loaded = parse_settings(
      "can: {dbc: r.dbc}\nodometry: {left: W.L, right: W.L}\n", "robot.yaml",
      "BO_ 1 W: 4 A\n SG_ L : 0|16@1- (1,0) [0|0] \"m\" A\n SG_ X 0|8@1+ (1,0) [0|0] \"\" A\n");
  EXPECT_THAT(loaded.faults, IsEmpty());
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("r.dbc:3:8: expected ':'")));
}

}  // namespace
}  // namespace zonepack
