// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/replay_command.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "runtime/odometry/det_math.hpp"
#include "runtime/run/figures/summary_text.hpp"

namespace zonepack {
namespace {

TEST(ParseStart, TakesFixTruthOrAPoseInDegrees) {
  EXPECT_EQ(parse_start("fix")->kind, StartChoice::Kind::kFix);
  EXPECT_EQ(parse_start("truth")->kind, StartChoice::Kind::kTruth);
  const auto pose = parse_start("-1.5,2,270");
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->kind, StartChoice::Kind::kPose);
  EXPECT_EQ(pose->pose.x_m, -1.5);
  EXPECT_EQ(pose->pose.y_m, 2);
  EXPECT_NEAR(pose->pose.yaw_rad, -kPi / 2, 1e-12);
}

TEST(ParseStart, TakesAPoseWithoutAWordAsOthersDo) {
  const auto pose = parse_pose("1.5,-2,90");
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->x_m, 1.5);
  EXPECT_EQ(pose->y_m, -2);
  EXPECT_NEAR(pose->yaw_rad, kPi / 2, 1e-12);
  for (const char* text : {"truth", "fix", "1,2,", "a,2,3", "1000001,0,0"}) {
    EXPECT_FALSE(parse_pose(text)) << text;
  }
}

TEST(ParseStart, RefusesAnythingElse) {
  for (const char* text : {"", "fix ", "1,2", "1,2,3,4", "1,,3", "1,2,x", "nan,0,0", "1,2,inf",
                           "0,0,1e300", "1e7,0,0", "0,-1e7,0", "1;2;3"}) {
    EXPECT_FALSE(parse_start(text)) << text;
  }
}

RunSummary summary() {
  RunSummary s;
  s.budget_bytes = 1083744;
  s.signatures_loaded = 113;
  s.zone_absent_s = 0.02;
  s.event_log_hash = "ab";
  return s;
}

TEST(SummaryJson, HasTheKeysThatScriptsRelyOn) {
  RunSummary s = summary();
  s.pose_error_m = PoseError{.p50 = 0.1, .p95 = 0.2, .max = 0.3};
  const auto json = nlohmann::ordered_json::parse(summary_json(s));
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"budget_bytes",
                                            "peak_charged_bytes",
                                            "budget_violations",
                                            "max_signatures",
                                            "peak_signatures",
                                            "signatures_loaded",
                                            "signatures_unloaded",
                                            "zones_loaded",
                                            "zones_unloaded",
                                            "bytes_loaded",
                                            "zone_switches",
                                            "localised",
                                            "start_s",
                                            "zone_absent_s",
                                            "blocked_s",
                                            "wrong_zone_s",
                                            "pose_error_m",
                                            "cycles",
                                            "can_frames",
                                            "can_rejected",
                                            "corrections_used",
                                            "corrections_rejected",
                                            "event_log_hash"}));
  EXPECT_EQ(json["budget_bytes"], 1083744);
  EXPECT_EQ(json["zone_absent_s"], 0.02);
  EXPECT_EQ(json["pose_error_m"]["p95"], 0.2);
  EXPECT_EQ(json["event_log_hash"], "ab");
}

TEST(SummaryJson, ClaimsNothingThatWasNotMeasured) {
  RunSummary s = summary();
  const auto json = nlohmann::json::parse(summary_json(s));
  EXPECT_TRUE(json["wrong_zone_s"].is_null());
  EXPECT_EQ(json["localised"], true);
  EXPECT_EQ(summary_table(s).find("in a wrong zone"), std::string::npos);
  s.wrong_zone_s = 0;
  s.localised = false;
  const auto lost = nlohmann::json::parse(summary_json(s));
  EXPECT_EQ(lost["wrong_zone_s"], 0);
  EXPECT_EQ(lost["localised"], false);
  EXPECT_TRUE(lost["zone_absent_s"].is_null());
  EXPECT_TRUE(lost["start_s"].is_null());
  EXPECT_NE(summary_table(s).find("NEVER LOCALISED"), std::string::npos);
  EXPECT_NE(summary_table(s).find("in a wrong zone"), std::string::npos);
}

TEST(SummaryJson, HasNoPoseErrorWithoutTruth) {
  EXPECT_TRUE(nlohmann::json::parse(summary_json(summary()))["pose_error_m"].is_null());
}

TEST(SummaryTable, NamesTheBudgetInBytesAndMebibytes) {
  EXPECT_NE(summary_table(summary()).find("1.03 MiB (1083744 bytes)"), std::string::npos);
}

}  // namespace
}  // namespace zonepack
