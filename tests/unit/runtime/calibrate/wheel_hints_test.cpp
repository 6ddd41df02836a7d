// SPDX-License-Identifier: Apache-2.0
// The sample drive, read with settings that hold one mistake each.
#include "runtime/calibrate/wheel_hints.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "platform/base/number_text.hpp"
#include "platform/can/can_log.hpp"
#include "runtime/calibrate/wheel_watch.hpp"
#include "runtime/run/inputs/run_files.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kDrive = ZONEPACK_TEST_DATA "/scenario1_loop/";

std::string agilex() {
  std::ifstream file(ZONEPACK_SOURCE_DIR "/config/agilex.yaml");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string swapped(const std::string& text) {
  return changed(changed(text, "left: left_position", "left: right_position"),
                 "right: right_position", "right: left_position");
}

// With `factor` on both wheels' signals, which count millimetres.
std::string with_factor(std::string text, double factor) {
  const std::string line = "factor: " + short_number(factor, 12);
  text = changed(std::move(text), "factor: 0.001         # mm to m", line);
  const std::size_t right = text.find("factor: 0.001", text.find("right_position:"));
  return text.replace(right, std::string("factor: 0.001").size(), line);
}

Settings settings_of(const std::string& text) {
  LoadedSettings loaded = parse_settings(text, ZONEPACK_SOURCE_DIR "/config/robot.yaml");
  EXPECT_THAT(loaded.faults, IsEmpty());
  return loaded.settings;
}

enum class Against { kTruePath, kFixes, kTwist };

std::vector<WheelHint> hints_for(const std::string& text, Against against = Against::kTruePath) {
  const Settings settings = settings_of(text);
  std::optional<TruthTrack> track;
  if (against == Against::kTruePath) track = read_truth(kDrive + "base_groundtruth.txt").value();
  if (against == Against::kFixes) {
    track = track_of(read_corrections(kDrive + "corrections.txt").value());
  }
  Reference reference;
  if (track) reference = {motion_on(*track), "the truth"};
  WheelWatch watch(settings, reference);
  CanLogReader log(kDrive + "can0.log", settings.can.interface);
  EXPECT_TRUE(log.open());
  while (const auto frame = log.next()) watch.take(*frame);
  return wheel_hints(settings, watch.evidence());
}

// The one hint that is expected.
WheelHint hint_for(const std::string& text, Against against = Against::kTruePath) {
  const auto hints = hints_for(text, against);
  EXPECT_EQ(hints.size(), 1u);
  return hints.empty() ? WheelHint() : hints[0];
}

TEST(WheelHints, TheRightSettingsGiveNone) {
  EXPECT_THAT(hints_for(agilex()), IsEmpty());
  EXPECT_THAT(hints_for(agilex(), Against::kFixes), IsEmpty());
  EXPECT_THAT(hints_for(agilex(), Against::kTwist), IsEmpty());
}

TEST(WheelHints, SwappedWheelsAreSwappedBack) {
  for (const Against against : {Against::kTruePath, Against::kFixes, Against::kTwist}) {
    const WheelHint hint = hint_for(swapped(agilex()), against);
    EXPECT_EQ(hint.kind, "swapped");
    EXPECT_THAT(hint.yaml,
                ElementsAre("odometry:", "  left: left_position", "  right: right_position"));
  }
}

TEST(WheelHints, AWheelThatCountsBackwardsIsInverted) {
  const std::string left = changed(agilex(), "  unit: metres", "  invert: [left]\n  unit: metres");
  EXPECT_EQ(hint_for(left).kind, "sign");
  EXPECT_THAT(hint_for(left).text, HasSubstr("odometry.left (left_position) counts backwards"));
  EXPECT_THAT(hint_for(left).yaml, ElementsAre("odometry:", "  invert: []"));
  // The signal itself counts backwards, so that the key is needed.
  std::string minus = agilex();
  const std::size_t at = minus.find("factor: 0.001", minus.find("right_position:"));
  minus.insert(at + std::string("factor: ").size(), "-");
  EXPECT_THAT(hint_for(minus).yaml, ElementsAre("odometry:", "  invert: [right]"));
}

TEST(WheelHints, TheKeyOfASignalThatIsSwappedAndCountsBackwardsIsThatOfItsTrueSide) {
  // left: right_position counts backwards: it is the right wheel's, so invert: [right].
  std::string text = swapped(agilex());
  const std::size_t at = text.find("factor: 0.001", text.find("right_position:"));
  text.insert(at + std::string("factor: ").size(), "-");
  const auto hints = hints_for(text);
  ASSERT_EQ(hints.size(), 2u);
  EXPECT_EQ(hints[0].kind, "swapped");
  EXPECT_EQ(hints[1].kind, "sign");
  for (const WheelHint& hint : hints) {
    EXPECT_THAT(hint.yaml, ElementsAre("odometry:", "  left: left_position",
                                       "  right: right_position", "  invert: [right]"));
  }
}

TEST(WheelHints, AMissingGearIsNamedWithItsRatio) {
  // Turns of a motor before a gear of 30: 0.001 m are 0.001 / (2 pi 0.14 m) * 30 turns = 0.0341046.
  const std::string turns =
      changed(with_factor(agilex(), 0.034104629), "unit: metres", "unit: turns");
  for (const Against against : {Against::kTruePath, Against::kFixes, Against::kTwist}) {
    EXPECT_EQ(hint_for(turns, against).kind, "gear");
    EXPECT_THAT(hint_for(turns, against).yaml, ElementsAre("odometry:", "  gear: 30"));
  }
  EXPECT_THAT(hints_for(changed(turns, "unit: turns", "unit: turns\n  gear: 30")), IsEmpty());
  // One that is given although the signals are those of the wheel: 0.0341046 / 30 = 0.00113682.
  const std::string wheel =
      changed(with_factor(agilex(), 0.00113682), "unit: metres", "unit: turns\n  gear: 30");
  EXPECT_THAT(hint_for(wheel).yaml, ElementsAre("odometry:", "  gear: 1"));
}

struct UnitCase {
  double factor;     // of the signals
  const char* unit;  // of the settings
  const char* right;
};

TEST(WheelHints, AWrongUnitIsNamed) {
  // 1 mm is 0.001 m / 0.14 m = 0.00714286 rad = 0.00113682 turns = 0.409256 degrees.
  for (const UnitCase& c : {UnitCase{1, "metres", "mm"},
                            {0.001, "mm", "metres"},
                            {0.00714286, "turns", "radians"},
                            {0.00113682, "radians", "turns"},
                            {0.409256, "radians", "degrees"},
                            {0.00714286, "degrees", "radians"}}) {
    const std::string text =
        changed(with_factor(agilex(), c.factor), "unit: metres", std::string("unit: ") + c.unit);
    const WheelHint hint = hint_for(text);
    EXPECT_EQ(hint.kind, "unit") << c.unit;
    EXPECT_THAT(hint.yaml, ElementsAre("odometry:", std::string("  unit: ") + c.right)) << c.unit;
  }
}

TEST(WheelHints, AFactorThatNoUnitExplainsIsDividedOut) {
  const WheelHint hint = hint_for(with_factor(agilex(), 0.0036));
  EXPECT_EQ(hint.kind, "factor");
  EXPECT_THAT(hint.text, HasSubstr("by 3.6 (km/h for m/s"));
  EXPECT_THAT(hint.yaml,
              ElementsAre("can:", "  signals:", "    left_position:", "      factor: 0.001",
                          "    right_position:", "      factor: 0.001"));
}

TEST(WheelHints, OneSignalForBothWheelsIsSeenInTheSettings) {
  const WheelHint hint =
      hint_for(changed(agilex(), "right: right_position", "right: left_position"));
  EXPECT_EQ(hint.kind, "same-signal");
  EXPECT_THAT(hint.yaml, ElementsAre("odometry:", "  right: right_position"));
}

TEST(WheelHints, ACounterThatIsReadAsASpeedIsSeenByItsRise) {
  const std::string speeds =
      changed(agilex(), "model: differential-positions", "model: wheel-speeds");
  EXPECT_EQ(hint_for(speeds).kind, "counter-as-speed");
  EXPECT_THAT(hint_for(speeds).yaml, ElementsAre("odometry:", "  model: differential-positions"));
}

TEST(WheelHints, ASpeedThatIsReadAsAPositionComesBack) {
  const std::string positions =
      changed(changed(agilex(), "left: left_position", "left: linear_velocity"),
              "right: right_position", "right: turn_rate");
  EXPECT_EQ(hint_for(positions).kind, "speed-as-position");
  EXPECT_THAT(hint_for(positions).yaml, ElementsAre("odometry:", "  model: wheel-speeds"));
}

TEST(WheelHints, ATrackOfAnotherRobotIsCorrected) {
  const WheelHint hint = hint_for(changed(agilex(), "track: 0.413", "track: 0.05"));
  EXPECT_EQ(hint.kind, "track");
  ASSERT_EQ(hint.yaml.size(), 2u);
  EXPECT_THAT(hint.yaml[1], HasSubstr("  track: 0.41"));  // the simulated robot's is 0.4171
}

TEST(WheelHints, SignalsOfSomethingElseDoNotFollowTheRobot) {
  // Four bits from the middle of the counter, as a number of their own.
  std::string text = changed(agilex(), "start: 7\n      length: 32", "start: 31\n      length: 4");
  const auto hints = hints_for(text);
  ASSERT_FALSE(hints.empty());
  EXPECT_THAT(hints[0].text, HasSubstr("odometry.left (left_position)"));
}

// Four windows straight on and four to the left, of wheels that report `times` the way.
std::deque<DriveWindow> windows(double times, double track_m, bool forward_known = true) {
  std::deque<DriveWindow> all;
  for (int i = 0; i < 4; ++i) {
    all.push_back({2, times, times, {1, 0, forward_known}});
    all.push_back(
        {2, -0.5 * track_m / 2 * times, 0.5 * track_m / 2 * times, {0, 0.5, forward_known}});
  }
  return all;
}

TEST(WheelHints, SpeedsInOtherUnitsAreNamed) {
  Settings settings = settings_of(agilex());
  OdometrySettings& o = settings.odometry;
  o.wheels.model = OdometryModel::kWheelSpeeds;
  const auto yaml_of = [&settings, &o](WheelUnit unit, double times) {
    o.unit = unit;
    WheelEvidence evidence;
    evidence.windows = windows(times, o.wheels.geometry.track_m);
    const auto hints = wheel_hints(settings, evidence);
    EXPECT_EQ(hints.size(), 1u) << times;
    return hints.empty() ? std::vector<std::string>() : hints[0].yaml;
  };
  EXPECT_THAT(yaml_of(WheelUnit::kMetres, 3.6), ElementsAre("odometry:", "  unit: km/h"));
  EXPECT_THAT(yaml_of(WheelUnit::kTurns, 60), ElementsAre("odometry:", "  unit: rpm"));
  // rpm for rad/s: 60 / (2 pi).
  EXPECT_THAT(yaml_of(WheelUnit::kRadians, 9.5493), ElementsAre("odometry:", "  unit: rpm"));
  EXPECT_THAT(yaml_of(WheelUnit::kRpm, 20), ElementsAre("odometry:", "  gear: 20"));
  o.pole_pairs = 1;
  EXPECT_THAT(yaml_of(WheelUnit::kErpm, 15), ElementsAre("odometry:", "  pole_pairs: 15"));
  o.ticks_per_turn = 1024;
  EXPECT_THAT(yaml_of(WheelUnit::kTicks, 4), ElementsAre("odometry:", "  ticks_per_turn: 4096"));
}

TEST(WheelHints, AGyroscopeTellsSwappedWheelsAndASign) {
  const Settings settings = settings_of(agilex());
  WheelEvidence evidence;
  evidence.windows = windows(1, 0.413, false);
  EXPECT_THAT(wheel_hints(settings, evidence), IsEmpty());
  for (DriveWindow& window : evidence.windows) std::swap(window.left_m, window.right_m);
  auto hints = wheel_hints(settings, evidence);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints[0].kind, "swapped");
  evidence.windows = windows(1, 0.413, false);
  for (DriveWindow& window : evidence.windows) window.left_m = -window.left_m;
  hints = wheel_hints(settings, evidence);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  invert: [left]"));
}

TEST(WheelHints, WheelsThatOnlyGoOppositeWaysAreDoubted) {
  // 6 m forward and 6 m back, with nothing to compare with.
  const Settings settings = settings_of(
      "can: {signals: {l: {id: 1, start: 0, length: 16, type: signed},\n"
      "                r: {id: 1, start: 16, length: 16, type: signed}}}\n"
      "odometry: {model: differential-positions, left: l, right: r, unit: mm}\n");
  WheelWatch watch(settings);
  for (int i = 0; i <= 600; ++i) {
    CanFrame frame;
    frame.id = 1;
    frame.len = 4;
    frame.stamp_ns = i * 20'000'000ll;
    const int left = 10 * i, right = -10 * i;
    frame.data = {static_cast<std::uint8_t>(left & 0xFF), static_cast<std::uint8_t>(left >> 8),
                  static_cast<std::uint8_t>(right & 0xFF),
                  static_cast<std::uint8_t>(right >> 8 & 0xFF)};
    watch.take(frame);
  }
  const auto hints = wheel_hints(settings, watch.evidence());
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_THAT(hints[0].text, HasSubstr("opposite ways, 6.0 and -6.0 m"));
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  invert: [right]"));
}

// Without a reference only the limits speak.
TEST(WheelHints, SpeedsThatNoRobotHasAskForAUnitOrAGear) {
  Settings settings = settings_of(agilex());
  WheelEvidence evidence;
  evidence.samples = 100;
  evidence.too_fast = 80;
  evidence.usual_speed_m_s = 900;  // mm/s
  auto hints = wheel_hints(settings, evidence);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_EQ(hints[0].kind, "too-fast");
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  unit: mm"));
  // 31 m/s of 3: at least 10.33, rounded up.
  settings.odometry.unit = WheelUnit::kTurns;
  evidence.usual_speed_m_s = 31;
  hints = wheel_hints(settings, evidence);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_THAT(hints[0].yaml, ElementsAre("odometry:", "  gear: 11"));
  evidence.too_fast = 49;  // of 100: less than half
  EXPECT_THAT(wheel_hints(settings, evidence), IsEmpty());
}

TEST(WheelHints, AreWrittenForPeopleAndForPrograms) {
  const WheelHint hint{
      .kind = "gear", .text = "a \"gear\" is missing", .yaml = {"odometry:", "  gear: 30"}};
  EXPECT_EQ(hint_text(hint), "hint: a \"gear\" is missing; write\n    odometry:\n      gear: 30\n");
  EXPECT_EQ(hints_json({hint}),
            "[{\"kind\": \"gear\", \"text\": \"a \\\"gear\\\" is missing\", \"yaml\": "
            "\"odometry:\\u000a  gear: 30\\u000a\"}]");
  EXPECT_EQ(hints_json({}), "[]");
}

}  // namespace
}  // namespace zonepack
