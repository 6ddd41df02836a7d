// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/place_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/image_changes.hpp"
#include "tests/unit/runtime/localize/query/made_view.hpp"

namespace zonepack::localize {
namespace {

class PlaceSearchTest : public testing::Test, protected MadeView {
 protected:
  struct Found {
    std::vector<Sighting> matches;
    ImageFeatures image;
    int right = 0;  // within 2 px of where the map has the point
  };
  Found find(const GreyImage& image, const Pose2& prior) {
    Candidates candidates;
    candidates.best = {{&map_, 0}};
    Found out;
    out.image = detector_.detect(image, camera_);
    PlaceDescriber describer(detector_, image);
    out.matches = find_places(describer, candidates, camera_, {prior, {0.01, 0, 0, 0.01, 0, 0.001}},
                              MatchOptions{}, out.image);
    for (const Sighting& one : out.matches) {
      const MapPoint& point = map_.points[one.row];
      const Eigen::Vector2d off = one.px - Eigen::Vector2d(point.x_px, point.y_px);
      out.right += off.norm() <= 2 ? 1 : 0;
    }
    return out;
  }
};

TEST_F(PlaceSearchTest, FindsTheMapNearAPriorThatIsOff) {
  const Found found = find(view_, {3.05, -2.05, 0.72});
  EXPECT_GT(found.right, 60);
  EXPECT_GT(found.right, 0.9 * static_cast<double>(found.matches.size()));
}

TEST_F(PlaceSearchTest, FindsItInABlurredImage) {
  const Found found = find(*test_support::changed(view_, "blur:3"), {3.05, -2.05, 0.72});
  EXPECT_GT(found.right, 30);
  EXPECT_GT(found.right, 0.5 * static_cast<double>(found.matches.size()));
}

TEST_F(PlaceSearchTest, AddsAFeatureForEachMatchAndLeavesTheOthers) {
  const Found found = find(view_, kPlace);
  ASSERT_EQ(found.image.size(), features_.size() + found.matches.size());
  EXPECT_EQ(found.image.descriptors.size(), found.image.size() * found.image.descriptor_bytes);
  EXPECT_TRUE(std::equal(features_.px.begin(), features_.px.end(), found.image.px.begin()));
  for (std::size_t i = 0; i < found.matches.size(); ++i) {
    EXPECT_EQ(found.matches[i].feature, features_.size() + i);
    EXPECT_EQ(found.image.px[features_.size() + i].cast<double>(), found.matches[i].px);
  }
}

TEST_F(PlaceSearchTest, FindsNothingInBlankImagesOrBehindTheCamera) {
  EXPECT_TRUE(find(test_support::filled(view_, 200), kPlace).matches.empty());
  EXPECT_TRUE(find(view_, {3, -2, 0.7 + 3.14}).matches.empty());
}

// 2560x1920 are described at every sixteenth pixel.
TEST_F(PlaceSearchTest, FindsItInALargeImageAsWell) {
  GreyImage large;
  large.width = 4 * view_.width;
  large.height = 4 * view_.height;
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      large.pixels.push_back(view_.pixels[static_cast<std::size_t>(y / 4 * view_.width + x / 4)]);
    }
  }
  CameraModel camera = camera_;
  camera.width = large.width;
  camera.height = large.height;
  camera.fx *= 4;
  camera.fy *= 4;
  camera.cx = 4 * camera.cx + 1.5;
  camera.cy = 4 * camera.cy + 1.5;
  ImageFeatures image = detector_.detect(large, camera);
  const MapFeatures map = made_signature(image, camera, detector_.settings().descriptor_bytes());
  Candidates candidates;
  candidates.best = {{&map, 0}};
  PlaceDescriber describer(detector_, large);
  const std::vector<Sighting> matches =
      find_places(describer, candidates, camera, {kPlace, {0.001, 0, 0, 0.001, 0, 1e-5}},
                  MatchOptions{}, image);
  int right = 0;
  for (const Sighting& one : matches) {
    const Eigen::Vector2d off =
        one.px - Eigen::Vector2d(map.points[one.row].x_px, map.points[one.row].y_px);
    right += off.norm() <= 2 ? 1 : 0;
  }
  EXPECT_GT(right, 20);
  EXPECT_GT(right, 0.8 * static_cast<double>(matches.size()));
}

TEST_F(PlaceSearchTest, LooksForAtMostSoManyPlaces) {
  EXPECT_LE(find(view_, kPlace).matches.size(), 120U);
}

}  // namespace
}  // namespace zonepack::localize
