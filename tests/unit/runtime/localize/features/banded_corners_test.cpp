// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/banded_corners.hpp"

#include <gtest/gtest.h>

#include <opencv2/features2d.hpp>
#include <tuple>

#include "tests/unit/runtime/localize/features/made_blobs.hpp"

namespace zonepack::localize {
namespace {

class BandedCornersAgainstOpenCv
    : public testing::TestWithParam<std::tuple<int, double, bool, double>> {};

TEST_P(BandedCornersAgainstOpenCv, FindTheSameCornersInTheSameOrder) {
  DetectorSettings settings;
  settings.max_features = 300;
  settings.quality = 0.01;
  std::tie(settings.block_px, settings.min_distance_px, settings.harris, settings.harris_k) =
      GetParam();
  const cv::Mat image = made_blobs(333, 247, 7, 2.5);  // the height is no multiple of a band's
  std::vector<cv::KeyPoint> ours, theirs;
  BandedCorners(settings).detect(image, ours);
  cv::GFTTDetector::create(settings.max_features, settings.quality, settings.min_distance_px,
                           settings.block_px, settings.harris, settings.harris_k)
      ->detect(image, theirs);
  ASSERT_EQ(theirs.size(), 300U);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].pt, theirs[i].pt) << i;
    EXPECT_EQ(ours[i].size, theirs[i].size) << i;
    EXPECT_EQ(ours[i].angle, theirs[i].angle) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Settings, BandedCornersAgainstOpenCv,
                         testing::Values(std::tuple(3, 7.0, false, 0.04),
                                         std::tuple(7, 4.0, false, 0.04),
                                         std::tuple(3, 0.0, false, 0.04),
                                         std::tuple(3, 5.0, true, 0.04)));

TEST(BandedCorners, FindNoneInABlankImage) {
  std::vector<cv::KeyPoint> found(3);
  BandedCorners(DetectorSettings{}).detect(cv::Mat(100, 100, CV_8UC1, cv::Scalar(128)), found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace zonepack::localize
