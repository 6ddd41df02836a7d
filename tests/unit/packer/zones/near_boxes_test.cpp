// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/near_boxes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "packer/zones/plane.hpp"

namespace zonepack::packer {
namespace {

TEST(NearBoxes, AreThoseThatComparingAllWithAllFinds) {
  std::mt19937 chance(1);
  const auto any = [&](double most) {
    return std::uniform_real_distribution<double>(0, most)(chance);
  };
  std::vector<Box2> boxes;
  for (int i = 0; i < 300; ++i) {
    const Point2 corner{any(50), any(200)};
    boxes.push_back({corner, {corner.x_m + any(9), corner.y_m + any(9)}});
  }
  for (const double margin_m : {0.0, 0.5}) {
    NearBoxes near(boxes);
    std::uint64_t looked_at = 0;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
      std::vector<std::uint32_t> expected;
      for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
        if (boxes_meet(boxes[a], boxes[b], margin_m)) expected.push_back(b);
      }
      EXPECT_EQ(near.after(a, margin_m, looked_at), expected) << a;
    }
    EXPECT_LT(looked_at, boxes.size() * boxes.size() / 4);
  }
}

// 50,000 rooms: floors above each other, wings side by side, and as many of one as of the other.
TEST(NearBoxes, TakeFewStepsHoweverABuildingLies) {
  constexpr std::uint32_t kRooms = 50'000;
  for (const std::uint32_t wide : {20u, 2'500u, 224u}) {
    std::vector<Box2> boxes;
    for (std::uint32_t i = 0; i < kRooms; ++i) {
      const Point2 corner{6.0 * (i % wide), 5.0 * (i / wide)};
      boxes.push_back({corner, {corner.x_m + 6, corner.y_m + 5}});
    }
    NearBoxes near(std::move(boxes));
    std::uint64_t looked_at = 0, found = 0;
    for (std::uint32_t a = 0; a < kRooms; ++a) found += near.after(a, 0, looked_at).size();
    EXPECT_GT(found, 3 * kRooms) << wide;
    EXPECT_LT(looked_at, std::uint64_t{1'000} * kRooms) << wide;
  }
}

}  // namespace
}  // namespace zonepack::packer
