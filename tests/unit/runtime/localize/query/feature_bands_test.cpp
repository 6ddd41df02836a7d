// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/feature_bands.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>

#include "runtime/localize/features/hamming.hpp"
#include "tests/unit/runtime/localize/query/made_view.hpp"

namespace zonepack::localize {
namespace {

class FeatureBandsTest : public testing::Test, protected MadeView {
 protected:
  // Feature and distance of each in the window.
  std::map<std::uint32_t, std::uint16_t> inside(const SearchWindows::Window& window) {
    std::map<std::uint32_t, std::uint16_t> out;
    bands_.for_each_inside(
        window,
        [&](const std::uint8_t* rows, std::size_t count, std::uint16_t* distances) {
          hamming_rows(features_.descriptor(0), rows, count, features_.descriptor_bytes, distances);
        },
        [&](std::uint32_t feature, std::uint16_t distance) {
          EXPECT_TRUE(out.emplace(feature, distance).second) << "twice";
        });
    return out;
  }

  FeatureBands bands_{features_};
};

TEST_F(FeatureBandsTest, GivesEachFeatureOfAWindowWithItsOwnDistance) {
  std::mt19937 random(3);
  const auto some = [&](unsigned most) { return static_cast<float>(random() % most); };
  for (int k = 0; k < 200; ++k) {
    const SearchWindows::Window window{{some(700) - 30, some(540) - 30}, {some(300), some(200)}};
    std::map<std::uint32_t, std::uint16_t> expected;
    for (std::uint32_t i = 0; i < features_.size(); ++i) {
      const Eigen::Vector2f off = (features_.px[i] - window.middle).cwiseAbs();
      if (off.x() > window.half.x() || off.y() > window.half.y()) continue;
      expected[i] = static_cast<std::uint16_t>(
          hamming_plain(features_.descriptor(0), features_.descriptor(i), 32));
    }
    EXPECT_EQ(inside(window), expected) << k;
  }
}

TEST_F(FeatureBandsTest, GivesAllOfAWindowThatIsLargerThanTheImage) {
  EXPECT_EQ(inside({{320, 240}, {1e4F, 1e4F}}).size(), features_.size());
}

TEST_F(FeatureBandsTest, GivesNothingOfAWindowBesideTheImage) {
  EXPECT_TRUE(inside({{-500, 240}, {100, 100}}).empty());
  EXPECT_TRUE(inside({{320, 2000}, {100, 100}}).empty());
}

TEST(FeatureBands, OfAnImageWithoutFeaturesAreEmpty) {
  ImageFeatures nothing;
  nothing.width = 640, nothing.height = 480, nothing.descriptor_bytes = 32;
  FeatureBands bands(nothing);
  int calls = 0;
  bands.for_each_inside(
      {{320, 240}, {1e4F, 1e4F}}, [](auto...) {}, [&](auto...) { ++calls; });
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace zonepack::localize
