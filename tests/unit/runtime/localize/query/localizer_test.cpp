// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/localizer.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/support/image_changes.hpp"
#include "tests/unit/runtime/localize/query/made_view.hpp"
#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

// A map of one signature that took the image at kPlace: each feature at a depth of 1 to 5 m.
class LocalizerTest : public testing::Test {
 protected:
  explicit LocalizerTest(const DetectorSettings& detector = {})
      : localizer_(made_camera(), detector) {
    const CameraModel camera = made_camera();
    const auto features = localizer_.detect(view_);
    map_ = made_signature(*features, camera, detector.descriptor_bytes());
  }

  QueryResult query(const GreyImage& image, const std::optional<QueryPrior>& prior) {
    const MapFeatures* const all[] = {&map_};
    return localizer_.query(image, all, prior);
  }

  const QueryPrior near_{{3.2, -2.1, 0.75}, {0.09, 0, 0, 0.09, 0, 0.0076}};
  GreyImage view_ = made_view();
  Localizer localizer_;
  MapFeatures map_;
};

TEST_F(LocalizerTest, FindsWhereTheImageWasTaken) {
  const QueryResult result = query(view_, near_);
  ASSERT_TRUE(result.accepted) << to_string(result.reason);
  EXPECT_NEAR(result.pose.x_m, 3, 0.002);
  EXPECT_NEAR(result.pose.y_m, -2, 0.002);
  EXPECT_NEAR(result.pose.yaw_rad, 0.7, 0.001);
  EXPECT_GT(result.distinct, 100);
  EXPECT_EQ(result.best, 7);
}

TEST_F(LocalizerTest, FindsItWithoutAPrior) {
  const QueryResult result = query(view_, {});
  ASSERT_TRUE(result.accepted) << to_string(result.reason);
  EXPECT_NEAR(result.pose.x_m, 3, 0.002);
}

TEST_F(LocalizerTest, GivesTheSameBitsAgain) {
  const QueryResult once = query(view_, near_), again = query(view_, near_);
  EXPECT_EQ(once.pose, again.pose);
  EXPECT_EQ(once.covariance, again.covariance);
  EXPECT_EQ(once.inliers, again.inliers);
}

TEST_F(LocalizerTest, BearsWhatADayDoesToImages) {
  for (const char* change : {"gain:0.5", "gain:1.5", "gamma:1.5", "noise:5"}) {
    const QueryResult result = query(*test_support::changed(view_, change), near_);
    ASSERT_TRUE(result.accepted) << change << ": " << to_string(result.reason);
    EXPECT_NEAR(result.pose.x_m, 3, 0.02) << change;
  }
}

// A blur over 10 pixels leaves few corners where the map has them; what is seen where the pose says
// so is evidence, too.
TEST_F(LocalizerTest, LooksAgainAtTheImageWhereEvidenceIsShort) {
  const GreyImage blurred = *test_support::changed(view_, "blur:10");
  const MapFeatures* const all[] = {&map_};
  const auto features = localizer_.detect(blurred);
  const QueryResult once = localizer_.locate(*features, all, near_);
  EXPECT_EQ(once.reason, Reason::kChance);
  EXPECT_EQ(once.looked_at, 0);
  const QueryResult twice = localizer_.locate(*features, all, near_, &blurred);
  EXPECT_TRUE(twice.accepted) << to_string(twice.reason);
  EXPECT_NEAR(twice.pose.x_m, 3, 0.2);
  EXPECT_NEAR(twice.evidence, once.evidence + 0.5 * (twice.recognised - 0.05 * twice.looked_at),
              1e-9);
  EXPECT_GT(twice.recognised, 10);
  EXPECT_EQ(query(view_, near_).looked_at, 0);  // nothing is in doubt
}

TEST_F(LocalizerTest, AcceptsNothingThatIsNoView) {
  for (const char* change : {"flip", "fill:0", "fill:255"}) {
    const QueryResult result = query(*test_support::changed(view_, change), near_);
    EXPECT_FALSE(result.accepted) << change;
  }
  EXPECT_EQ(query(test_support::filled(view_, 0), near_).reason, Reason::kNoFeatures);
}

// What x86-64 gives; other processors must come within 2 mm, a milliradian and a twentieth of the
// inliers, as OpenCV's kernels may round corners differently there.
TEST_F(LocalizerTest, FindsTheSameOnEveryProcessor) {
  struct Expected {
    const char* change;
    Pose2 pose;
    int distinct;
  };
  for (const Expected& expected : {Expected{"none", {3, -2, 0.7}, 454},
                                   Expected{"gamma:1.5", {3.00006, -1.99999, 0.70002}, 409},
                                   Expected{"cover:0.3", {3.00003, -2.00002, 0.7}, 290}}) {
    const QueryResult result = query(*test_support::changed(view_, expected.change), near_);
    ASSERT_TRUE(result.accepted) << expected.change;
    EXPECT_NEAR(result.pose.x_m, expected.pose.x_m, 0.002) << expected.change;
    EXPECT_NEAR(result.pose.y_m, expected.pose.y_m, 0.002) << expected.change;
    EXPECT_NEAR(result.pose.yaw_rad, expected.pose.yaw_rad, 0.001) << expected.change;
    EXPECT_NEAR(result.distinct, expected.distinct, 0.05 * expected.distinct) << expected.change;
  }
}

TEST_F(LocalizerTest, NeedsMoreEvidenceFarFromThePrior) {
  // The same image and place: only the prior moves, by 0.5 m against a standard deviation of 0.3.
  QueryPrior at = near_, off = near_;
  at.T_map_base = kPlace;
  off.T_map_base = kPlace;
  off.T_map_base.x_m += 0.5;
  const QueryResult here = query(view_, at), there = query(view_, off);
  ASSERT_TRUE(here.accepted);
  ASSERT_TRUE(there.accepted);
  // 0.25 / (0.09 + 0.01) = 2.5 squared standard deviations, each half a point.
  EXPECT_NEAR(here.evidence - there.evidence, 1.25, 0.05);
}

// A signature with about so many of its points.
MapFeatures thinned(const MapFeatures& map, std::size_t points) {
  MapFeatures out = map;
  out.points.clear();
  out.descriptors.clear();
  const std::size_t step = map.points.size() / points;
  for (std::size_t row = 0; row < map.points.size(); row += step) {
    out.points.push_back(map.points[row]);
    const auto from =
        map.descriptors.begin() + static_cast<std::ptrdiff_t>(row * map.descriptor_bytes);
    out.descriptors.insert(out.descriptors.end(), from, from + map.descriptor_bytes);
  }
  return out;
}

// Ten points are enough, until the same stand 0.4 m farther on, too: a floor that repeats.
TEST_F(LocalizerTest, BelievesNoPoseWhileAnotherNearbyExplainsAsMuch) {
  QueryPrior between = near_;
  between.T_map_base = {kPlace.x_m + 0.2, kPlace.y_m, kPlace.yaw_rad};
  const MapFeatures once = thinned(map_, 10);
  MapFeatures again = once;
  again.id = 8;
  again.T_map_base.translation().x() += 0.4;
  const MapFeatures* const one[] = {&once};
  const MapFeatures* const both[] = {&once, &again};
  const QueryResult sure = localizer_.query(view_, one, between);
  ASSERT_TRUE(sure.accepted) << to_string(sure.reason);
  EXPECT_LT(sure.evidence, 12);
  const QueryResult result = localizer_.query(view_, both, between);
  EXPECT_FALSE(result.accepted);
  EXPECT_EQ(result.reason, Reason::kRival);
}

// Maps of the other detectors.
class OtherDetectors : public LocalizerTest, public testing::WithParamInterface<Detector> {
 protected:
  OtherDetectors() : LocalizerTest(settings()) {}
  static DetectorSettings settings() {
    DetectorSettings out;
    out.detector = GetParam();
    return out;
  }
};

TEST_P(OtherDetectors, FindWhereTheImageWasTaken) {
  const QueryResult result = query(*test_support::changed(view_, "gain:0.7"), near_);
  ASSERT_TRUE(result.accepted) << to_string(GetParam()) << ": " << to_string(result.reason);
  EXPECT_NEAR(result.pose.x_m, 3, 0.01);
  EXPECT_NEAR(result.pose.y_m, -2, 0.01);
  EXPECT_NEAR(result.pose.yaw_rad, 0.7, 0.005);
}

INSTANTIATE_TEST_SUITE_P(All, OtherDetectors,
                         testing::Values(Detector::kOrb, Detector::kSift, Detector::kBrisk),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_F(LocalizerTest, SaysWhyThereIsNoPose) {
  GreyImage half = view_;
  half.height = 240;
  half.pixels.resize(640 * 240);
  EXPECT_EQ(query(half, near_).reason, Reason::kWrongSize);
  QueryPrior away = near_;
  away.T_map_base.x_m += 50;
  EXPECT_EQ(query(view_, away).reason, Reason::kNoSignature);
  QueryPrior turned = near_;
  turned.T_map_base.yaw_rad += 3.1;
  const QueryResult result = query(view_, turned);
  EXPECT_EQ(result.reason, Reason::kNotInView);
  EXPECT_EQ(result.nearest, 7);
}

}  // namespace
}  // namespace zonepack::localize
