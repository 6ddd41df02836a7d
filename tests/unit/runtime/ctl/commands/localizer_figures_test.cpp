// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/localizer_figures.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace zonepack {
namespace {

using testing::HasSubstr;

class LocalizerFigures : public testing::Test {
 protected:
  const wire::Status& status(bool with_localizer) {
    builder_.Clear();
    std::vector<flatbuffers::Offset<wire::Localizer>> rows;
    if (with_localizer) {
      const std::vector reasons{
          wire::CreateFixReason(builder_, builder_.CreateString("few_matches"), 40),
          wire::CreateFixReason(builder_, builder_.CreateString("gathered"), 10)};
      const auto list = builder_.CreateVector(reasons);
      const auto camera = builder_.CreateString("v4l2:/dev/video0");
      const wire::Timing latency(950, 31'000'000, 52'000'000, 0, 0, 70'000'000);
      const wire::Timing query(1000, 15'000'000, 21'000'000, 0, 0, 30'000'000);
      rows.push_back(
          wire::CreateLocalizer(builder_, camera, 1000, 950, 7, 2, &latency, &query, list));
    }
    const auto list = builder_.CreateVector(rows);
    wire::StatusBuilder body(builder_);
    body.add_localizers(list);
    builder_.Finish(body.Finish());
    return *flatbuffers::GetRoot<wire::Status>(builder_.GetBufferPointer());
  }

  flatbuffers::FlatBufferBuilder builder_;
};

// 950 of 1000: 95 %.
TEST_F(LocalizerFigures, AreALineOfText) {
  EXPECT_THAT(localizer_lines(status(true)),
              testing::ElementsAre(
                  "localizer v4l2:/dev/video0: fixes of 95.0 % of 1000 images, 31 ms after the "
                  "image, p99 52 ms; without one: few_matches 40, gathered 10; 2 images refused"));
  EXPECT_TRUE(localizer_lines(status(false)).empty());
}

TEST_F(LocalizerFigures, AreJson) {
  const auto all = nlohmann::json::parse(localizers_json(status(true)));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0]["fixes"], 950);
  EXPECT_EQ(all[0]["share"], 0.95);
  EXPECT_EQ(all[0]["latency_ms"]["p99"], 52);
  EXPECT_EQ(all[0]["query_ms"]["p50"], 15);
  EXPECT_EQ(all[0]["reasons"]["gathered"], 10);
  EXPECT_EQ(localizers_json(status(false)), "[]");
}

TEST_F(LocalizerFigures, AreMetrics) {
  const std::string text = localizer_metrics(status(true));
  EXPECT_THAT(text, HasSubstr("# TYPE zoned_localizer_fixes_total counter\n"
                              "zoned_localizer_fixes_total{camera=\"v4l2:/dev/video0\"} 950\n"));
  EXPECT_THAT(text, HasSubstr("zoned_localizer_no_fix_total{camera=\"v4l2:/dev/video0\","
                              "reason=\"few_matches\"} 40\n"));
  EXPECT_THAT(text, HasSubstr("zoned_localizer_latency_seconds{camera=\"v4l2:/dev/video0\","
                              "percentile=\"99\"} 0.052\n"));
  EXPECT_EQ(localizer_metrics(status(false)), "");
}

}  // namespace
}  // namespace zonepack
