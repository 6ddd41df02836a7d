// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/orb_comparisons.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <utility>
#include <vector>

#include "tests/unit/runtime/localize/features/made_blobs.hpp"

namespace zonepack::localize {
namespace {

constexpr int kEdge_px = 31;

cv::Ptr<cv::ORB> orb(int wta_k, int patch_px) {
  return cv::ORB::create(500, 2, 3, kEdge_px, 0, wta_k, cv::ORB::HARRIS_SCORE, patch_px, 20);
}

cv::Mat blobs(int width, int height) { return made_blobs(width, height, 11, 3); }

class OrbComparisonsAgainstOpenCv : public testing::TestWithParam<int> {};

TEST_P(OrbComparisonsAgainstOpenCv, DescribeEveryPlaceAlike) {
  const auto opencv = orb(2, GetParam());
  auto ours = OrbComparisons::read(*opencv, GetParam(), kEdge_px);
  ASSERT_TRUE(ours);
  for (const auto& [width, height] : {std::pair(211, 173), std::pair(640, 97)}) {
    const cv::Mat image = blobs(width, height);
    ours->use(image);
    std::vector<cv::KeyPoint> theirs;
    std::vector<bool> there(static_cast<std::size_t>(width * height));
    for (int y = 0; y < height; y += 3) {
      for (int x = 0; x < width; ++x) {
        theirs.emplace_back(static_cast<float>(x) + 0.3F, static_cast<float>(y) - 0.4F, 3.0F, -1.0F,
                            0.0F, 0, y * width + x);
      }
    }
    const std::vector<cv::KeyPoint> all = theirs;
    cv::Mat descriptors;
    opencv->compute(image, theirs, descriptors);
    ASSERT_GT(theirs.size(), 1000U);
    std::array<std::uint8_t, OrbComparisons::kBytes> bits{};
    for (std::size_t i = 0; i < theirs.size(); ++i) {
      there[static_cast<std::size_t>(theirs[i].class_id)] = true;
      ASSERT_TRUE(ours->place(theirs[i].pt.x, theirs[i].pt.y, bits.data()));
      ASSERT_TRUE(std::equal(bits.begin(), bits.end(), descriptors.ptr(static_cast<int>(i))))
          << theirs[i].pt;
    }
    for (const cv::KeyPoint& place : all) {
      EXPECT_EQ(ours->place(place.pt.x, place.pt.y, bits.data()),
                there[static_cast<std::size_t>(place.class_id)])
          << place.pt;
    }
  }
}

TEST_P(OrbComparisonsAgainstOpenCv, DescribeAGridAsItsPlaces) {
  auto ours = OrbComparisons::read(*orb(2, GetParam()), GetParam(), kEdge_px);
  ASSERT_TRUE(ours);
  ours->use(blobs(203, 151));
  for (const int step : {1, 4, 7}) {
    const int first = kEdge_px + 1, columns = (203 - kEdge_px - 1 - first) / step + 1,
              rows = (151 - kEdge_px - 1 - first) / step + 1;
    std::vector<std::uint8_t> grid(static_cast<std::size_t>(columns * rows) *
                                   OrbComparisons::kBytes);
    ours->grid(first, step, columns, rows, grid.data());
    std::array<std::uint8_t, OrbComparisons::kBytes> bits{};
    const std::uint8_t* at = grid.data();
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column, at += OrbComparisons::kBytes) {
        ASSERT_TRUE(ours->place(static_cast<float>(first + column * step),
                                static_cast<float>(first + row * step), bits.data()));
        ASSERT_TRUE(std::equal(bits.begin(), bits.end(), at))
            << step << ": " << column << " " << row;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Patches, OrbComparisonsAgainstOpenCv, testing::Values(31, 25));

TEST(OrbComparisons, AreNoneOfWhatComparesOtherwise) {
  EXPECT_FALSE(OrbComparisons::read(*orb(3, 31), 31, kEdge_px));
  EXPECT_FALSE(OrbComparisons::read(*cv::BRISK::create(), 31, kEdge_px));
}

TEST(OrbComparisons, AreNoneOfAPatchThatReachesBeyondTheEdge) {
  EXPECT_FALSE(OrbComparisons::read(*orb(2, 31), 31, 15));
}

}  // namespace
}  // namespace zonepack::localize
