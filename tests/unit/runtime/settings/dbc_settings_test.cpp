// SPDX-License-Identifier: Apache-2.0
// Signals by DBC file and name in the settings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "platform/can/can_log.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kConfig = ZONEPACK_SOURCE_DIR "/config/";

// Settings in the folder config/, with more lines in the section odometry.
LoadedSettings with_dbc(const std::string& more, const std::string& left = "Odometry.LeftWheel",
                        const std::string& dbc = "agilex.dbc") {
  return parse_settings("can:\n  dbc: " + dbc + "\nodometry:\n  left: " + left +
                            "\n  right: Odometry.RightWheel\n" + more,
                        kConfig + "robot.yaml");
}

TEST(DbcSettings, SignalsOfADbcFileAreThoseWrittenOut) {
  const LoadedSettings named = with_dbc("  timeout: 0.3\n");
  EXPECT_THAT(named.faults, IsEmpty());
  const Settings written = load_settings(kConfig + "agilex.yaml").settings;
  EXPECT_EQ(named.settings.odometry.wheels.signals[0], written.odometry.wheels.signals[0]);
  EXPECT_EQ(named.settings.odometry.wheels.signals[1], written.odometry.wheels.signals[1]);
  EXPECT_EQ(named.settings.can.dbc, kConfig + "agilex.dbc");
  EXPECT_EQ(named.settings.can.signals.count("Odometry.LeftWheel"), 1u);
}

TEST(DbcSettings, GiveTheSameMotionBitForBitOverAWholeDrive) {
  const Settings named = with_dbc("  timeout: 0.3\n").settings;
  const Settings written = load_settings(kConfig + "agilex.yaml").settings;
  WheelOdometry a(named.odometry.wheels);
  WheelOdometry b(written.odometry.wheels);
  CanLogReader log(ZONEPACK_TEST_DATA "/scenario1_loop/can0.log");
  ASSERT_TRUE(log.open().ok());
  std::size_t steps = 0;
  while (const auto frame = log.next()) {
    const auto x = a.take(*frame);
    const auto y = b.take(*frame);
    ASSERT_EQ(x.has_value(), y.has_value());
    if (!x) continue;
    ++steps;
    ASSERT_EQ(x->motion.pose, y->motion.pose);
    ASSERT_EQ(x->motion.covariance, y->motion.covariance);
  }
  EXPECT_EQ(steps, 5522u);
}

TEST(DbcSettings, TheCycleTimeOfTheFramesSetsTheTimeout) {
  // 20 ms, three times.
  EXPECT_DOUBLE_EQ(with_dbc("").settings.odometry.wheels.timeout_s, 0.06);
  EXPECT_EQ(with_dbc("  timeout: 0.5\n").settings.odometry.wheels.timeout_s, 0.5);
  // At least two control cycles: 2 / 20 Hz.
  const LoadedSettings slow = with_dbc("cycle:\n  period_hz: 20\n");
  EXPECT_THAT(slow.faults, IsEmpty());
  EXPECT_EQ(slow.settings.odometry.wheels.timeout_s, 0.1);
  // Signals of can.signals have no cycle time.
  EXPECT_EQ(load_settings(kConfig + "agilex.yaml").settings.odometry.wheels.timeout_s, 0.3);
}

TEST(DbcSettings, FaultsNameTheFileTheLineAndWhatIsThere) {
  EXPECT_THAT(
      with_dbc("", "Odometry.LeftWeel").faults,
      ElementsAre(testing::AllOf(HasSubstr("robot.yaml:4: odometry.left: "),
                                 HasSubstr("agilex.dbc:18: Odometry has no signal LeftWeel; "
                                           "did you mean \"LeftWheel\"?"))));
  EXPECT_THAT(
      with_dbc("", "LeftWheel").faults,
      ElementsAre(HasSubstr("no signal \"LeftWheel\" in can.signals; a signal of can.dbc is "
                            "named MESSAGE.SIGNAL")));
  EXPECT_THAT(with_dbc("", "Odometry.LeftWheel", "none.dbc").faults,
              ElementsAre(HasSubstr("none.dbc: cannot be read: No such file")));
}

TEST(DbcSettings, WrittenSignalsComeBeforeThoseOfTheFile) {
  const LoadedSettings both = parse_settings(
      "can:\n  dbc: agilex.dbc\n  signals:\n    Odometry.LeftWheel: {id: 5, length: 8}\n"
      "odometry: {left: Odometry.LeftWheel, right: Odometry.RightWheel}\n",
      kConfig + "robot.yaml");
  EXPECT_THAT(both.faults, IsEmpty());
  EXPECT_EQ(both.settings.odometry.wheels.signals[0].id, 5u);
  EXPECT_EQ(both.settings.odometry.wheels.signals[1].id, 0x311u);
}

}  // namespace
}  // namespace zonepack
