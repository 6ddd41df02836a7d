// SPDX-License-Identifier: Apache-2.0
// The camera's loop over the recorded drive, with a finder that gives the truth with an error.
#include "runtime/localize/replay/camera_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "platform/can/can_log.hpp"
#include "runtime/localize/query/fix_slack.hpp"
#include "runtime/localize/replay/fixes_file.hpp"
#include "runtime/localize/replay/loop_figures.hpp"
#include "runtime/replay/replay.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/sample_catalog.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

const std::string kData = ZONEPACK_TEST_DATA;
const std::string kRun = kData + "/scenario1_loop/";
constexpr std::int64_t kHalfSecond_ns = 500'000'000;

class CameraLoopTest : public testing::Test {
 protected:
  // An image every half second of the drive.
  std::vector<LoopImage> images() const {
    std::vector<LoopImage> out;
    const std::int64_t last = truth.samples().back().t_ns;
    for (std::int64_t t = truth.samples().front().t_ns; t <= last; t += kHalfSecond_ns) {
      out.push_back({t, t, "image"});
    }
    return out;
  }

  // 2 cm off along x, one image in seven without a fix.
  ImageFinder finder() {
    return [this](const LoopImage& image, std::span<const MapFeatures* const>,
                  const QueryPrior&) -> Outcome<QueryResult> {
      ++queries;
      if (queries % 13 == 0) return failure("image: is damaged");
      QueryResult result;
      result.reason = Reason::kFewInliers;
      const auto pose = truth.at(image.stamp_ns);
      if (!pose || queries % 7 == 0) return result;
      result.accepted = true;
      result.reason = Reason::kAccepted;
      result.pose = *pose;
      result.pose.x_m += 0.02;
      result.covariance = {0.0009, 0, 0, 0.0009, 0, 0.0001};
      return result;
    };
  }

  ReplayResult drive(FixSource* fixes, std::vector<PoseCorrection> corrections,
                     RunObserver* observer = nullptr) {
    CanLogReader log(kRun + "can0.log");
    EXPECT_TRUE(log.open().ok());
    ReplayInput input{catalog, log};
    input.corrections = std::move(corrections);
    input.truth = &truth;
    input.start.kind = StartChoice::Kind::kTruth;
    input.cycle = testing_support::sample_robot();
    input.load_packs = false;
    input.terms.budget = 64 * kMiB;
    input.fixes = fixes;
    input.observer = observer;
    auto result = replay(std::move(input));
    EXPECT_TRUE(result);
    return std::move(*result);
  }

  int queries = 0;
  const Catalog catalog = testing_support::sample_catalog(kData + "/zones.geojson");
  const TruthTrack truth = *read_truth(kRun + "base_groundtruth.txt");
};

TEST_F(CameraLoopTest, WritesFixesThatGiveTheSameEventsFromAFile) {
  for (const std::int64_t latency_ns : {std::int64_t{0}, std::int64_t{150'000'000}}) {
    queries = 0;
    CameraLoop loop(images(), finder(), {.latency_ns = latency_ns, .descriptor_bytes = 32});
    const ReplayResult looped = drive(&loop, {});
    ASSERT_GT(looped.summary.corrections_used, 100u);

    const test_support::TemporaryFolder folder;
    const std::string file = folder / "fixes.txt";
    ASSERT_TRUE(write_fixes(file, loop.views()));
    const auto fixes = read_corrections(file);
    ASSERT_TRUE(fixes) << fixes.error().message;
    EXPECT_EQ(drive(nullptr, *fixes).summary.event_log_hash, looped.summary.event_log_hash);
    // Without them it is another run.
    EXPECT_NE(drive(nullptr, {}).summary.event_log_hash, looped.summary.event_log_hash);
  }
}

TEST_F(CameraLoopTest, HandsAFixOverWhenTheLatencyHasPassed) {
  CameraLoop loop(images(), finder(), {.latency_ns = 150'000'000, .descriptor_bytes = 32});
  drive(&loop, {});
  for (const LoopView& view : loop.views()) {
    if (!view.result.accepted) continue;
    EXPECT_EQ(view.fix.stamp_ns, view.image.stamp_ns);
    EXPECT_EQ(view.fix.received_ns, view.image.stamp_ns + 150'000'000);
    EXPECT_EQ(view.fix.view_m, kView_m);
  }
}

TEST_F(CameraLoopTest, CountsWhatBecameOfEachImage) {
  CameraLoop loop(images(), finder(), {.latency_ns = 150'000'000, .descriptor_bytes = 32});
  HeadingWatch heading(&truth);
  const ReplayResult result = drive(&loop, {}, &heading);
  const LoopFigures f = figures_of(loop, result.summary, heading, &truth);
  const auto all = static_cast<std::size_t>(queries);
  EXPECT_EQ(f.images, all);
  // Every 13th is damaged; of the others every 7th has no fix.
  EXPECT_EQ(f.reasons.at("unreadable_image"), all / 13);
  EXPECT_EQ(f.reasons.at("few_inliers"), all / 7 - all / 91);
  EXPECT_EQ(f.accepted, all - all / 13 - all / 7 + all / 91);
  EXPECT_EQ(f.right, f.accepted);
  EXPECT_EQ(f.wrong, 0u);
  EXPECT_NEAR(f.fix_error_m->max, 0.02, 1e-9);
  // Queries 13 and 14 give none: from the 12th image to the 15th.
  EXPECT_NEAR(f.longest_gap_s, 1.5, 1e-6);
  EXPECT_LT(f.run.pose_error_m->p95, 0.06);
  EXPECT_LT(f.yaw_error_deg->p95, 1.0);
  EXPECT_EQ(loop.warnings().front(), "image: is damaged");
}

// The finder is 2 cm off and says 3: honest. 20 cm to either side with sigmas of 1 mm is not.
TEST_F(CameraLoopTest, NoticesFixesThatClaimTooMuch) {
  CameraLoop honest(images(), finder(), {.latency_ns = 0, .descriptor_bytes = 32});
  drive(&honest, {});
  EXPECT_EQ(honest.widest(), 1);
  queries = 0;
  const ImageFinder find = finder();
  const auto boast = [&](const LoopImage& image, std::span<const MapFeatures* const> map,
                         const QueryPrior& prior) -> Outcome<QueryResult> {
    auto result = find(image, map, prior);
    if (!result) return result;
    result->pose.y_m += queries % 2 == 0 ? 0.2 : -0.2;
    result->covariance = {1e-6, 0, 0, 1e-6, 0, 1e-6};
    return result;
  };
  CameraLoop boasting(images(), boast, {.latency_ns = 0, .descriptor_bytes = 32});
  drive(&boasting, {});
  EXPECT_GT(boasting.widest(), 2);
}

TEST_F(CameraLoopTest, AsksNothingOfAnImageWhileThePoseIsUnknown) {
  CameraLoop loop(images(), finder(), {.latency_ns = 0, .descriptor_bytes = 32});
  const ResidentZones none(nullptr);
  CycleState lost;
  std::vector<PoseCorrection> fixes;
  loop.after_cycle({truth.samples().front().t_ns, lost, none}, fixes);
  EXPECT_EQ(queries, 0);
  EXPECT_TRUE(fixes.empty());
  ASSERT_EQ(loop.views().size(), 1u);
  EXPECT_STREQ(reason_of(loop.views().front()), "no_pose");
}

TEST(PriorAt, CarriesThePoseBackWithItsSpeed) {
  PoseEstimate estimate;
  estimate.t_ns = 2'000'000'000;
  estimate.T_map_base = {1, 2, std::numbers::pi / 2};
  estimate.speed_m_s = 0.8;
  // A tenth of a second earlier, 8 cm behind: the robot drives along y.
  const QueryPrior prior = prior_at(1'900'000'000, estimate);
  EXPECT_NEAR(prior.T_map_base.x_m, 1, 1e-12);
  EXPECT_NEAR(prior.T_map_base.y_m, 1.92, 1e-12);
  EXPECT_NEAR(prior.T_map_base.yaw_rad, std::numbers::pi / 2, 1e-12);
}

TEST(LoopFiguresTest, TellRightFromWrongByPlaceAndHeading) {
  const Pose2 truth{1, 1, 3.1};
  EXPECT_TRUE(is_right({1.3, 1.4, 3.1}, truth));        // 0.5 m
  EXPECT_FALSE(is_right({1.3, 1.41, 3.1}, truth));      // more
  EXPECT_TRUE(is_right({1, 1, -3.1}, truth));           // 4.8 degrees, across the cut
  EXPECT_FALSE(is_right({1, 1, 3.1 - 0.1746}, truth));  // 10.004 degrees
}

TEST(LoopFiguresTest, SayNullForWhatIsUnknown) {
  LoopFigures figures;
  figures.run.localised = false;
  const std::string json = figures_json(figures);
  for (const char* const key :
       {"right", "wrong", "fix_error_m", "fix_error_map_m", "pose_error_m", "yaw_error_deg",
        "wrong_zone_s", "zone_absent_s", "query_ms", "found_after_views", "found_after_s"}) {
    EXPECT_NE(json.find("\"" + std::string(key) + "\": null"), std::string::npos) << key;
  }
  EXPECT_NE(json.find("\"reasons\": {}"), std::string::npos);
}

TEST(SpreadTest, TakesTheNearestRank) {
  // 1 to 21: the 11th is the median, the 20th has 95 % at or below it.
  std::vector<double> values;
  for (int i = 21; i >= 1; --i) values.push_back(i);
  const auto spread = spread_of(values);
  ASSERT_TRUE(spread);
  EXPECT_EQ(spread->p50, 11);
  EXPECT_EQ(spread->p95, 20);
  EXPECT_EQ(spread->max, 21);
  EXPECT_FALSE(spread_of({}));
}

}  // namespace
}  // namespace zonepack::localize
