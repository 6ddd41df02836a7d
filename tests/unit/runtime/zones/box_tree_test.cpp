// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace zonepack {
namespace {

std::vector<std::uint32_t> near(const BoxTree& tree, Point2 point, double radius_m) {
  std::vector<std::uint32_t> found;
  tree.visit_near(point, radius_m, [&](std::uint32_t box) { found.push_back(box); });
  std::sort(found.begin(), found.end());
  return found;
}

double distance_to(const Box2& box, Point2 p) {
  const double dx = std::max({box.min.x_m - p.x_m, 0.0, p.x_m - box.max.x_m});
  const double dy = std::max({box.min.y_m - p.y_m, 0.0, p.y_m - box.max.y_m});
  return std::hypot(dx, dy);
}

TEST(BoxTree, OfNoBoxesFindsNothing) { EXPECT_TRUE(near(BoxTree(), {0, 0}, 1e9).empty()); }

TEST(BoxTree, VisitsEveryBoxWithinTheRadius) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-50, 50), size(0, 5);
  std::vector<Box2> boxes;
  for (int i = 0; i < 500; ++i) {
    const Point2 min{place(random), place(random)};
    boxes.push_back({min, {min.x_m + size(random), min.y_m + size(random)}});
  }
  const BoxTree tree(boxes);
  for (int i = 0; i < 200; ++i) {
    const Point2 point{place(random), place(random)};
    const double radius = i % 2 == 0 ? 0 : size(random);
    const auto found = near(tree, point, radius);
    for (std::uint32_t b = 0; b < boxes.size(); ++b) {
      // Boxes of the same leaf may be reported too: the caller checks the polygon anyway.
      if (distance_to(boxes[b], point) <= radius) {
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), b)) << b;
      }
    }
  }
}

TEST(BoxTree, LooksAtFewBoxesAmongAHundredThousandHoweverUnevenTheyLie) {
  // Two dense wards of 0.1 m boxes, 10 km apart: a regular grid over both would put each into one
  // cell.
  std::vector<Box2> boxes;
  for (int ward = 0; ward < 2; ++ward) {
    for (int i = 0; i < 50'000; ++i) {
      const Point2 min{ward * 10'000.0 + 0.1 * (i % 250), 0.1 * (i / 250)};
      boxes.push_back({min, {min.x_m + 0.09, min.y_m + 0.09}});
    }
  }
  const BoxTree tree(boxes);
  const auto found = near(tree, {10'000.0 + 12.34, 7.65}, 0.01);
  EXPECT_LE(found.size(), 32u);
  // Column 123 (12.30 to 12.39), row 76 (7.60 to 7.69).
  EXPECT_TRUE(std::binary_search(found.begin(), found.end(), 50'000u + 76 * 250 + 123));
}

TEST(BoxTree, EndsWithManyBoxesAtOnePlace) {
  const std::vector<Box2> boxes(1000, Box2{{0, 0}, {1, 1}});
  EXPECT_EQ(near(BoxTree(boxes), {0.5, 0.5}, 0).size(), 1000u);
}

}  // namespace
}  // namespace zonepack
