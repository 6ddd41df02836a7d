// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/listen_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace zonepack {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kConfig = ZONEPACK_SOURCE_DIR "/config/agilex.yaml";
const std::string kDrive = ZONEPACK_TEST_DATA "/scenario1_loop/";

struct Said {
  int code = 0;
  std::string out, err;
};

// ListenArguments without the source.
struct Asked {
  std::string config = kConfig;
  std::optional<double> duration_s = {};
  std::string truth = {}, corrections = {}, json = {};
  std::optional<ExpectedMotion> expected = {};
  bool once = false;
};

Said listen(const Asked& asked, const std::string& can) {
  ListenArguments arguments;
  arguments.config = asked.config;
  arguments.duration_s = asked.duration_s;
  arguments.truth = asked.truth;
  arguments.corrections = asked.corrections;
  arguments.json = asked.json;
  arguments.expected = asked.expected;
  arguments.once = asked.once;
  const auto feed = parse_feed_choice(can);
  EXPECT_TRUE(feed) << can;
  arguments.feed = *feed;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Said said;
  said.code = run_listen(arguments);
  said.out = testing::internal::GetCapturedStdout();
  said.err = testing::internal::GetCapturedStderr();
  return said;
}

std::string written(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

TEST(FeedChoice, TakesTheSourcesOfARunAndThePlainNameOfALog) {
  using Kind = CanSourceChoice::Kind;
  EXPECT_EQ(parse_feed_choice("socketcan:can0")->source.kind, Kind::kSocketCan);
  EXPECT_EQ(parse_feed_choice("a.log")->source.name, "a.log");
  EXPECT_FALSE(parse_feed_choice("a.log")->paced);
  EXPECT_FALSE(parse_feed_choice("log:a.log")->paced);
  EXPECT_TRUE(parse_feed_choice("log:a.log@1")->paced);
  EXPECT_TRUE(parse_feed_choice("sim:a.yaml")->paced);
  for (const char* text : {"", "log:", "socketcan:", "sim:", "log:a@0"}) {
    EXPECT_FALSE(parse_feed_choice(text)) << text;
  }
}

TEST(ListenCommand, ReadsAWholeLogAndWritesJson) {
  const Said said =
      listen({.corrections = kDrive + "corrections.txt", .json = "-"}, kDrive + "can0.log");
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.err, HasSubstr("left_position"));
  const auto json = nlohmann::json::parse(said.out);
  EXPECT_EQ(json["signals"].size(), 4u);
  EXPECT_EQ(json["signals"][0]["key"], "left");
  EXPECT_EQ(json["signals"][0]["state"], "fresh");
  EXPECT_NEAR(json["signals"][0]["rate_hz"], 50, 0.1);
  EXPECT_NEAR(json["robot"]["distance_m"], 88.4, 0.1);  // the drive is 88 m long
  EXPECT_EQ(json["compared_with"], "the localizer's fixes");
  EXPECT_EQ(json["refused"], 0);
  EXPECT_THAT(json["hints"], IsEmpty());
  EXPECT_EQ(json["mismatch"], "");
}

TEST(ListenCommand, ALogWithoutTheFramesFailsWithWhatItHas) {
  const Said said =
      listen({.config = ZONEPACK_SOURCE_DIR "/config/vesc.yaml"}, kDrive + "can0.log");
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.out, HasSubstr("never seen"));
  EXPECT_THAT(said.err, AllOf(HasSubstr("holds none of the frames that odometry reads: expected "
                                        "0x00001B01 (29 bits)"),
                              HasSubstr("the log has 0x221 (11 bits)")));
}

TEST(ListenCommand, ADurationEndsALogEarly) {
  const Said said = listen({.duration_s = 10}, kDrive + "can0.log");
  EXPECT_EQ(said.code, 0);
  EXPECT_THAT(said.out, HasSubstr("can0.log: 10.0 s, 100"));
}

// Frames that the robot of the settings would send, a hundred times as fast.
TEST(ListenCommand, ASimulatedRobotThatDoesWhatIsExpectedPasses) {
  const std::string script =
      "sim:" + written("ahead.yaml", "drive: {legs: [{for: 4, speed: 0.5}]}\n") + "@100";
  Asked arguments{.once = true};
  arguments.duration_s = 60;
  arguments.expected = parse_expected_motion("forward");
  EXPECT_EQ(listen(arguments, script).code, 0);
  arguments.expected = parse_expected_motion("backward");
  const Said said = listen(arguments, script);
  EXPECT_EQ(said.code, 1);
  EXPECT_THAT(said.out, HasSubstr("      invert: [left, right]\n"));
  EXPECT_THAT(said.err, HasSubstr("did not move as expected (drive backward)"));
}

TEST(ListenCommand, NamesTheFileThatCannotBeUsed) {
  EXPECT_THAT(listen({.config = "/none.yaml"}, kDrive + "can0.log").err,
              HasSubstr("/none.yaml: cannot be read"));
  EXPECT_THAT(listen({}, "/none.log").err, HasSubstr("/none.log"));
  EXPECT_THAT(listen({.truth = "/none.txt"}, kDrive + "can0.log").err, HasSubstr("/none.txt"));
  const Said bus = listen({.truth = "t.txt"}, "socketcan:none0");
  EXPECT_EQ(bus.code, 2);
  const Said absent = listen({}, "socketcan:none0");
  EXPECT_EQ(absent.code, 1);
  EXPECT_THAT(absent.err, HasSubstr("none0"));
  const Said json = listen({.json = "/none/a.json"}, kDrive + "can0.log");
  EXPECT_EQ(json.code, 1);
  EXPECT_THAT(json.err, HasSubstr("/none/a.json: cannot be written"));
}

}  // namespace
}  // namespace zonepack
