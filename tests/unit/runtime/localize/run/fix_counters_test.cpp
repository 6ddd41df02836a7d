// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/fix_counters.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "runtime/localize/run/complaints.hpp"

namespace zonepack::localize {
namespace {

class FixCountersTest : public testing::Test {
 protected:
  FixCountersTest() {
    QueryResult fix;
    fix.accepted = true;
    fix.reason = Reason::kAccepted;
    fix.cpu_total_ns = 10'000'000;
    for (int i = 0; i < 3; ++i) counters_.count(fix, 30'000'000);
    QueryResult none;
    none.reason = Reason::kFewMatches;
    counters_.count(none, 0);
    counters_.count_without_pose();
    counters_.count_skipped(2);
    counters_.count_refused();
    counters_.count_not_taken();
  }
  FixCounters counters_;
};

// 3 of 5 images gave a fix, one of which zoned did not take.
TEST_F(FixCountersTest, AreWhatZonedIsTold) {
  flatbuffers::FlatBufferBuilder builder;
  builder.Finish(counters_.put(builder, "v4l2:/dev/video0"));
  const auto& told = *flatbuffers::GetRoot<wire::Localizer>(builder.GetBufferPointer());
  EXPECT_EQ(told.images_total(), 5U);
  EXPECT_EQ(told.fixes_total(), 2U);
  EXPECT_EQ(told.skipped_total(), 2U);
  EXPECT_EQ(told.refused_total(), 1U);
  EXPECT_EQ(told.latency()->count(), 3U);
  ASSERT_EQ(told.reasons()->size(), 2U);
  EXPECT_EQ(told.reasons()->Get(0)->reason()->str(), "few_matches");
  EXPECT_EQ(told.reasons()->Get(1)->reason()->str(), "no_pose");
}

TEST_F(FixCountersTest, AreASummary) {
  const auto all = nlohmann::json::parse(counters_.json(1234));
  EXPECT_EQ(all["images"], 5);
  EXPECT_EQ(all["accepted"], 3);
  EXPECT_EQ(all["share"], 0.6);
  EXPECT_EQ(all["fixes_sent"], 2);
  EXPECT_EQ(all["reasons"], (nlohmann::json{{"few_matches", 1}, {"no_pose", 1}}));
  EXPECT_NEAR(all["latency_ms"]["p95"].get<double>(), 30, 1);
  EXPECT_TRUE(all["query_ms"]["stages"].contains(to_string(Stage::kRansac)));
  EXPECT_EQ(all["rss_peak_bytes"], 1234);
  EXPECT_EQ(counters_.text(),
            "3 fixes of 5 images; without one: few_matches 1, no_pose 1; 1 fix not taken by zoned; "
            "1 image refused; 2 images skipped");
}

// 30 a second of the same kind: at 0, and after 10 s with the number of those in between.
TEST(ComplaintsTest, AreSaidOnceInTenSeconds) {
  std::vector<std::string> said;
  Complaints complaints([&](const std::string& text) { said.push_back(text); });
  for (int i = 0; i < 301; ++i) complaints.add("size", "wrong size", i * 33'333'334LL);
  complaints.add("stamp", "wrong stamp", 0);
  EXPECT_THAT(said, testing::ElementsAre("wrong size", "wrong size (300 times)", "wrong stamp"));
}

}  // namespace
}  // namespace zonepack::localize
