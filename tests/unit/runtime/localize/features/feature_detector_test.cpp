// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/feature_detector.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/runtime/localize/query/made_view.hpp"

namespace zonepack::localize {
namespace {

// OpenCV compares three pixels for two bits where WTA_K is 3, which only it can do.
class DescribingPlaces : public testing::TestWithParam<int> {
 protected:
  static DetectorSettings settings() {
    DetectorSettings out;
    out.wta_k = GetParam();
    return out;
  }
};

TEST_P(DescribingPlaces, GivesTheFeaturesOfTheDetectorWhereItFoundThem) {
  FeatureDetector detector(settings());
  const GreyImage view = made_view();
  CameraModel camera;
  camera.width = view.width;
  camera.height = view.height;
  const ImageFeatures features = detector.detect(view, camera);
  ASSERT_GT(features.size(), 300U);
  const DescribedPlaces places = PlaceDescriber(detector, view).places(features.seen_px);
  for (std::size_t i = 0; i < features.size(); ++i) {
    ASSERT_NE(places.find(i), nullptr);
    EXPECT_TRUE(std::equal(places.find(i), places.find(i) + places.descriptor_bytes,
                           features.descriptor(i)))
        << i;
  }
}

TEST_P(DescribingPlaces, GivesNothingNearTheBorder) {
  FeatureDetector detector(settings());
  const std::vector<Eigen::Vector2f> px{{3, 200}, {320, 477}, {320, 240}};
  const DescribedPlaces places = PlaceDescriber(detector, made_view()).places(px);
  EXPECT_EQ(places.find(0), nullptr);
  EXPECT_EQ(places.find(1), nullptr);
  EXPECT_NE(places.find(2), nullptr);
}

TEST_P(DescribingPlaces, GivesAGridAsItsPlaces) {
  FeatureDetector detector(settings());
  const GreyImage view = made_view();
  const DescribedGrid grid = PlaceDescriber(detector, view).grid(5);
  EXPECT_EQ(grid.first_px, 20);  // the first multiple of 5 that is 19 px inside
  EXPECT_EQ(grid.columns, 121);
  EXPECT_EQ(grid.rows, 89);
  std::vector<Eigen::Vector2f> px;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      px.emplace_back(static_cast<float>(grid.first_px + column * grid.step_px),
                      static_cast<float>(grid.first_px + row * grid.step_px));
    }
  }
  const DescribedPlaces places = PlaceDescriber(detector, view).places(px);
  for (std::size_t i = 0; i < px.size(); ++i) {
    ASSERT_NE(places.find(i), nullptr);
    ASSERT_TRUE(std::equal(places.find(i), places.find(i) + places.descriptor_bytes,
                           grid.descriptors.data() + i * grid.descriptor_bytes));
  }
}

TEST_P(DescribingPlaces, GivesAnEmptyGridOfAnImageThatIsAllBorder) {
  FeatureDetector detector(settings());
  GreyImage small;
  small.width = 38;
  small.height = 300;
  small.pixels.assign(38 * 300, 7);
  EXPECT_TRUE(PlaceDescriber(detector, small).grid(4).descriptors.empty());
}

INSTANTIATE_TEST_SUITE_P(ByOurselvesAndOpenCv, DescribingPlaces, testing::Values(2, 3));

}  // namespace
}  // namespace zonepack::localize
