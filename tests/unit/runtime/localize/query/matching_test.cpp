// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/matching.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/runtime/localize/solve/made_sightings.hpp"

namespace zonepack::localize {
namespace {

// A camera at the origin that looks along x, half a metre high; the map's one signature stands
// there too. Its points are 2 m before the camera (x = 2.2): a metre to the left is 385 / 2 = 192.5
// px to the left.
class MatchingTest : public testing::Test {
 protected:
  MatchingTest() {
    map_.T_map_base.setIdentity();
    map_.T_base_camera = camera_.T_base_camera;
    map_.descriptor_bytes = 32;
    image_.width = 640;
    image_.height = 480;
    image_.descriptor_bytes = 32;
  }
  // A descriptor of `bits` ones, or of none.
  static std::vector<std::uint8_t> look(int bits) {
    std::vector<std::uint8_t> out(32, 0);
    for (int i = 0; i < bits; ++i) out[static_cast<std::size_t>(i / 8)] |= 1 << (i % 8);
    return out;
  }
  void add_point(double left_m, int bits) {
    map_.points.push_back({0, 0, 2.2F, static_cast<float>(left_m), 0.5F});
    const auto bytes = look(bits);
    map_.descriptors.insert(map_.descriptors.end(), bytes.begin(), bytes.end());
  }
  // Features are added from left to right.
  void add_feature(double x_px, int bits) {
    image_.px.emplace_back(static_cast<float>(x_px), 239.5F);
    image_.seen_px.push_back(image_.px.back());
    const auto bytes = look(bits);
    image_.descriptors.insert(image_.descriptors.end(), bytes.begin(), bytes.end());
  }
  std::vector<Sighting> projected(double radius_px) {
    const Candidate all[] = {{&map_, 1}};
    return match_projected(image_, all, camera_, Eigen::Isometry3d::Identity(), radius_px, {});
  }
  std::vector<Sighting> in_windows(const QueryPrior& prior) {
    const Candidate all[] = {{&map_, 1}};
    return match_in_windows(image_, all, camera_, prior, 0, {});
  }

  CameraModel camera_ = made_camera();
  MapFeatures map_;
  ImageFeatures image_;
};

TEST_F(MatchingTest, FindsAPointWithinTheRadiusOfItsProjection) {
  add_point(0, 0);
  add_feature(319.5 + 7, 0);
  EXPECT_EQ(projected(6).size(), 0u);
  const auto found = projected(8);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].feature, 0u);
  EXPECT_EQ(found[0].p_map, Eigen::Vector3d(map_.points[0].x_m, 0, 0.5));
}

TEST_F(MatchingTest, WeighsByHowManyBitsDiffer) {
  // 30 bits and fewer count whole, 85 and more for nothing much: (85 - 52) / 55 = 0.6.
  add_point(0, 0);
  add_feature(319.5, 52);
  const auto found = projected(8);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].weight, 0.6, 1e-9);
}

TEST_F(MatchingTest, TakesTheAlikeOneOfTwoFeatures) {
  add_point(0, 10);
  add_feature(317, 60);
  add_feature(323, 12);
  const auto found = projected(8);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].feature, 1u);
}

TEST_F(MatchingTest, GivesAFeatureToTheMostAlikePointOnly) {
  add_point(0, 30);
  add_point(0.005, 11);  // a pixel to the left
  add_feature(319.5, 10);
  const auto found = projected(8);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].row, 1u);
}

TEST_F(MatchingTest, RefusesWhatDiffersInOver64Bits) {
  add_point(0, 0);
  add_feature(319.5, 64);
  EXPECT_EQ(projected(8).size(), 1u);
  image_.descriptors = look(65);
  EXPECT_EQ(projected(8).size(), 0u);
}

TEST_F(MatchingTest, LooksOnlyWhereThePriorLetsThePointBe) {
  // 10 cm to the side is 19.25 px; 2.5 of them and 14 px for tilt: 62 px.
  const QueryPrior prior{{0, 0, 0}, {1e-8, 0, 0, 0.01, 0, 1e-8}};
  add_point(0, 0);
  add_feature(319.5 + 61, 0);
  EXPECT_EQ(in_windows(prior).size(), 1u);
  image_.px[0].x() = 319.5F + 64;
  EXPECT_EQ(in_windows(prior).size(), 0u);
}

TEST_F(MatchingTest, LeavesOutAPointThatTwoFeaturesLookLike) {
  const QueryPrior prior{{0, 0, 0}, {0.01, 0, 0, 0.01, 0, 1e-4}};
  add_point(0, 0);
  add_feature(310, 20);
  add_feature(330, 23);  // 20 is over 0.85 * 23 = 19.55
  EXPECT_EQ(in_windows(prior).size(), 0u);
  const auto bytes = look(24);  // 0.85 * 24 = 20.4
  std::copy(bytes.begin(), bytes.end(), image_.descriptors.begin() + 32);
  EXPECT_EQ(in_windows(prior).size(), 1u);
}

TEST_F(MatchingTest, CountsFeaturesThatThePoseCouldExplain) {
  add_point(0, 0);
  add_point(1, 0);
  add_feature(319.5 - 192.5 + 5, 99);  // whatever it looks like
  add_feature(319.5, 0);
  add_feature(500, 0);
  const Candidate all[] = {{&map_, 1}};
  EXPECT_EQ(count_visible(image_, all, camera_, Eigen::Isometry3d::Identity(), 8), 2);
}

// Both points were seen from where the camera is; then from the other side, 2 m beyond them.
TEST_F(MatchingTest, ExpectsOnlyPointsThatWereSeenMuchAsNow) {
  add_point(0, 0);
  add_point(1, 0);
  add_feature(319.5 - 192.5 + 5, 99);
  add_feature(319.5, 0);
  const Candidate all[] = {{&map_, 1}};
  const auto expected = [&] {
    return count_visible(image_, all, camera_, Eigen::Isometry3d::Identity(), 8, 0.5);
  };
  EXPECT_EQ(expected(), 2);
  map_.T_base_camera.translation() = camera_.T_base_camera.translation() + Eigen::Vector3d(4, 0, 0);
  EXPECT_EQ(expected(), 0);
}

}  // namespace
}  // namespace zonepack::localize
