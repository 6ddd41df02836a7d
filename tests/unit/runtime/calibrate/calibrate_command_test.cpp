// SPDX-License-Identifier: Apache-2.0
// zoned calibrate on scenario 1, whose robot has wheels 0.5 % larger and a track 1 % wider than its
// settings say.
#include "runtime/calibrate/calibrate_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace zonepack {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::string kConfig = ZONEPACK_SOURCE_DIR "/config/agilex.yaml";
const std::string kLog = ZONEPACK_TEST_DATA "/scenario1_loop/can0.log";
const std::string kTruth = ZONEPACK_TEST_DATA "/scenario1_loop/base_groundtruth.txt";

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

WheelCalibration calibrate_scenario1(const Settings& settings) {
  const auto steps = read_wheel_steps(settings, kLog);
  EXPECT_TRUE(steps.ok()) << steps.error().message;
  const auto truth = read_truth(kTruth);
  EXPECT_TRUE(truth) << truth.error().message;
  const auto found = calibrate(*steps, *truth, settings.odometry.wheels);
  EXPECT_TRUE(found.ok()) << found.error().message;
  return found ? *found : WheelCalibration{};
}

// The text with each line of the section odometry replaced by that of `yaml`, where it has one.
std::string pasted(std::string text, const std::string& yaml) {
  std::istringstream lines(yaml);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "odometry:");
  while (std::getline(lines, line)) {
    const std::string key = "\n" + line.substr(0, line.find(':') + 1);
    const std::size_t at = text.find(key, text.find("\nodometry:"));
    EXPECT_NE(at, std::string::npos) << key;
    text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
  }
  return text;
}

TEST(CalibrateCommand, FindsWhatTheSimulatedRobotReallyIs) {
  const WheelCalibration c = calibrate_scenario1(load_settings(kConfig).settings);
  EXPECT_NEAR(c.fitted.left, 1.005, 3 * c.scale_sigma);
  EXPECT_NEAR(c.fitted.track_m, 0.413 * 1.01, 3 * c.track_sigma_m);
  EXPECT_LT(c.scale_sigma, 0.001);
  EXPECT_LT(c.track_sigma_m, 0.0015);
  EXPECT_FALSE(c.sides_differ);
  EXPECT_NEAR(c.distance_m, 88, 1);
  EXPECT_LT(c.after.end_m, c.before.end_m);
}

TEST(CalibrateCommand, WhatItPrintsCanBePastedAndThenChangesNothingMore) {
  const WheelCalibration first = calibrate_scenario1(load_settings(kConfig).settings);
  const std::string yaml = calibrated_yaml(first, load_settings(kConfig).settings.odometry);
  EXPECT_THAT(yaml, HasSubstr("  scale: 1.00"));
  EXPECT_THAT(yaml, HasSubstr("  track: 0.41"));
  const LoadedSettings after = parse_settings(pasted(text_of(kConfig), yaml), "a.yaml");
  ASSERT_THAT(after.faults, IsEmpty());
  const WheelCalibration second = calibrate_scenario1(after.settings);
  EXPECT_NEAR(second.fitted.left, 1, 1e-5);
  EXPECT_NEAR(second.fitted.track_m, first.fitted.track_m, 1e-5);
  EXPECT_NEAR(second.before.end_m, first.after.end_m, 1e-3);
}

TEST(CalibrateCommand, WritesTheKeysThatTheRobotHas) {
  WheelCalibration c;
  c.fitted = {.left = 1.01, .right = 0.99, .track_m = 0.6};
  c.sides_differ = true;
  OdometrySettings odometry;
  odometry.unit = WheelUnit::kTurns;
  odometry.wheel_radius_m = 0.1;
  odometry.scale_right = 2;
  odometry.wheels.geometry.track_m = 0.4;
  odometry.wheels.geometry.slip_factor = 1.4;
  const std::string yaml = calibrated_yaml(c, odometry);
  EXPECT_THAT(yaml, HasSubstr("  wheel_radius: 0.100000  #"));
  EXPECT_THAT(yaml, HasSubstr("  scale_left: 1.010000  #"));
  EXPECT_THAT(yaml, HasSubstr("  scale_right: 1.980000  #"));
  EXPECT_THAT(yaml, HasSubstr("  slip_factor: 1.500000  #"));
}

TEST(CalibrateCommand, WritesJsonAndSaysWhatIsWrong) {
  const std::string json = testing::TempDir() + "calibration.json";
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_calibrate({.config = kConfig, .can = kLog, .truth = kTruth, .json = json}), 0);
  const std::string out = testing::internal::GetCapturedStdout();
  EXPECT_THAT(out, HasSubstr("error at the end         1.0"));
  EXPECT_THAT(out,
              HasSubstr("Paste over the same keys of " + kConfig + ":\n\nodometry:\n  scale: "));
  const auto result = nlohmann::json::parse(text_of(json));
  EXPECT_NEAR(result["left"], 1.005, 0.003);
  EXPECT_GT(result["before"]["end_m"], result["after"]["end_m"]);
  EXPECT_EQ(result["sides_differ"], false);
  EXPECT_THAT(result["hints"], IsEmpty());

  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_calibrate({.config = kConfig, .can = kLog, .truth = kTruth, .json = "-"}), 0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), text_of(json));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), out);

  const auto fault_of = [](const CalibrateArguments& arguments) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_calibrate(arguments), 1);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(fault_of({.config = "/none.yaml", .can = kLog, .truth = kTruth, .json = ""}),
              HasSubstr("/none.yaml: cannot be read"));
  EXPECT_THAT(fault_of({.config = kConfig, .can = "/none.log", .truth = kTruth, .json = ""}),
              HasSubstr("/none.log"));
  EXPECT_THAT(fault_of({.config = kConfig, .can = kLog, .truth = "/none.txt", .json = ""}),
              HasSubstr("/none.txt"));
  EXPECT_THAT(fault_of({.config = ZONEPACK_SOURCE_DIR "/config/vesc.yaml",
                        .can = kLog,
                        .truth = kTruth,
                        .json = ""}),
              HasSubstr("holds none of the frames that odometry reads"));
  const std::string twist = testing::TempDir() + "twist.yaml";
  std::ofstream(twist) << "can: {signals: {a: {id: 1, length: 8}}}\n"
                          "odometry: {model: twist, forward: a, yaw_rate: a}\n";
  EXPECT_THAT(fault_of({.config = twist, .can = kLog, .truth = kTruth, .json = ""}),
              HasSubstr("wheel scale and track are those of differential-positions"));
}

TEST(CalibrateCommand, SaysWhatIsWrongInsteadOfFittingIt) {
  std::string swapped = text_of(kConfig);
  const auto put = [&swapped](const std::string& from, const std::string& to) {
    const std::size_t at = swapped.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    swapped.replace(at, from.size(), to);
  };
  put("left: left_position", "left: right_position");
  put("right: right_position", "right: left_position");
  const std::string config = testing::TempDir() + "swapped.yaml";
  std::ofstream(config) << swapped;
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_calibrate({.config = config, .can = kLog, .truth = kTruth, .json = ""}), 1);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("; write\n    odometry:\n      left: left_position\n"
                        "      right: right_position\n"));
}

}  // namespace
}  // namespace zonepack
