// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace zonepack::report {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMany = 1'000'000;

TEST(Thinning, AStraightLineIsItsTwoEnds) {
  std::vector<Waypoint> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({i * 0.1, {i * 0.3, 7, -i * 0.2}});
  EXPECT_EQ(corners_of(points, {0.001, 0.001, 0.001}, kMany), (std::vector<std::size_t>{0, 1000}));
}

TEST(Thinning, ACornerStays) {
  // Out for 10 s, and back.
  std::vector<Waypoint> points;
  for (int i = 0; i <= 20; ++i) points.push_back({i * 1.0, {i <= 10 ? i : 20.0 - i}});
  EXPECT_EQ(corners_of(points, {0.01, 1, 1}, kMany), (std::vector<std::size_t>{0, 10, 20}));
}

TEST(Thinning, NoDroppedPointIsMissedByMoreThanTheTolerance) {
  std::vector<Waypoint> points;
  for (int i = 0; i < 5000; ++i) {
    points.push_back({i * 0.1, {3 * std::sin(i * 0.01), 2 * std::cos(i * 0.017), i * 0.002}});
  }
  const std::vector<std::size_t> kept = corners_of(points, {0.01, 0.01, 0.02}, kMany);
  EXPECT_LT(kept.size(), 1000u);
  for (std::size_t k = 1; k < kept.size(); ++k) {
    const Waypoint &a = points[kept[k - 1]], &b = points[kept[k]];
    for (std::size_t i = kept[k - 1]; i <= kept[k]; ++i) {
      const double share = (points[i].t_s - a.t_s) / (b.t_s - a.t_s);
      for (std::size_t c = 0; c < 3; ++c) {
        const double line = a.value[c] + (b.value[c] - a.value[c]) * share;
        ASSERT_NEAR(points[i].value[c], line, c == 2 ? 0.0201 : 0.0101) << i;
      }
    }
  }
}

TEST(Thinning, AGapKeepsTheEndsOfWhatIsKnown) {
  const std::vector<Waypoint> points = {{0, {1}},        {1, {1}}, {2, {1}}, {3, {kUnknown}},
                                        {4, {kUnknown}}, {5, {1}}, {6, {1}}};
  EXPECT_EQ(corners_of(points, {0.1, 1, 1}, kMany), (std::vector<std::size_t>{0, 2, 3, 4, 5, 6}));
}

TEST(Thinning, NeverKeepsMoreThanAllowed) {
  std::vector<Waypoint> wild, gaps;
  for (int i = 0; i < 5000; ++i) {
    wild.push_back({i * 0.1, {i % 2 == 0 ? 1e6 : -1e6}});
    gaps.push_back({i * 0.1, {i % 2 == 0 ? 1.0 : kUnknown}});
  }
  EXPECT_LE(corners_of(wild, {0.01, 1, 1}, 100).size(), 100u);
  EXPECT_LE(corners_of(gaps, {0.01, 1, 1}, 100).size(), 100u);
  EXPECT_TRUE(corners_of({}, {1, 1, 1}, 100).empty());
}

TEST(Thinning, StepsKeepTheirChanges) {
  const std::vector<Sample> all = {{0, 5}, {1, 5},        {2, 7},       {3, 7},
                                   {4, 5}, {5, kUnknown}, {6, kUnknown}};
  const std::vector<Sample> kept = changes_of(all, kMany);
  ASSERT_EQ(kept.size(), 4u);
  EXPECT_EQ(kept[1].t_s, 2);
  EXPECT_EQ(kept[2].t_s, 4);
  EXPECT_EQ(kept[3].t_s, 5);
}

TEST(Thinning, TooManyStepsKeepTheirPeaks) {
  std::vector<Sample> all;
  for (int i = 0; i < 1000; ++i) all.push_back({i * 1.0, i == 501 ? 99.0 : i % 2 * 1.0});
  const std::vector<Sample> kept = changes_of(all, 50);
  EXPECT_LE(kept.size(), 50u);
  EXPECT_EQ(std::ranges::count(kept, 99.0, &Sample::value), 1);
}

}  // namespace
}  // namespace zonepack::report
