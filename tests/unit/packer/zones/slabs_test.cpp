// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/slabs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace zonepack::packer {
namespace {

std::vector<Weight> row(const std::vector<ByteCount>& bytes) {
  std::vector<Weight> weights;
  for (std::size_t i = 0; i < bytes.size(); ++i) weights.push_back({double(i), bytes[i]});
  return weights;
}

std::vector<double> starts(const std::vector<Gap>& cuts) {
  std::vector<double> places;
  for (const Gap& cut : cuts) places.push_back(cut.from_m);
  return places;
}

TEST(Slabs, NeedNoCutBelowTheLimit) {
  EXPECT_TRUE(choose_cuts(row({1, 2, 3}), 6, kOnePlace_m).empty());
  EXPECT_TRUE(choose_cuts({}, 6, kOnePlace_m).empty());
}

TEST(Slabs, AreEven) {
  // 8 of 1 under 5: two slabs of 4 rather than 5 and 3.
  EXPECT_EQ(starts(choose_cuts(row({1, 1, 1, 1, 1, 1, 1, 1}), 5, kOnePlace_m)),
            std::vector<double>{3});
}

TEST(Slabs, AreAsFewAsTheLimitAllows) {
  // 3 + 3 + 3 + 3 under 7: 6 and 6.  4 + 4 + 4 under 7: three slabs, though 12 / 7 < 2.
  EXPECT_EQ(choose_cuts(row({3, 3, 3, 3}), 7, kOnePlace_m).size(), 1u);
  EXPECT_EQ(choose_cuts(row({4, 4, 4}), 7, kOnePlace_m).size(), 2u);
}

TEST(Slabs, AreCutThroughTheWidestGapThatKeepsThemEven) {
  std::vector<Weight> weights;
  for (int i = 0; i < 20; ++i) weights.push_back({i + (i >= 11 ? 3.0 : 0.0), 1});
  // Even is 10 and 10; 11 and 9 is within 15 % and has a gap of 4 m.
  const auto cuts = choose_cuts(weights, 15, kOnePlace_m);
  ASSERT_EQ(cuts.size(), 1u);
  EXPECT_EQ(cuts[0].from_m, 10);
  EXPECT_EQ(cuts[0].to_m, 14);
}

TEST(Slabs, NeverPartWeightsAtOnePlace) {
  const std::vector<Weight> weights{{0, 3}, {1, 3}, {1, 3}, {1, 3}, {2, 3}};
  EXPECT_EQ(starts(choose_cuts(weights, 6, kOnePlace_m)), (std::vector<double>{0, 1}));
  EXPECT_TRUE(choose_cuts(std::vector<Weight>{{1, 3}, {1, 3}}, 4, kOnePlace_m).empty());
}

TEST(Slabs, PartWeightsWithinOnePlaceOnlyWhenAsked) {
  const std::vector<Weight> weights{{0, 3}, {0.004, 3}, {0.008, 3}, {0.012, 3}};
  EXPECT_EQ(starts(choose_cuts(weights, 6, kOnePlace_m)), std::vector<double>{0.008});
  EXPECT_EQ(starts(choose_cuts(weights, 6, 0)), std::vector<double>{0.004});
}

TEST(Slabs, StayWithinTheLimitForRandomWeights) {
  std::mt19937 random(11);
  for (int round = 0; round < 200; ++round) {
    std::vector<Weight> weights;
    const int count = 1 + int(random() % 60);
    ByteCount heaviest = 0;
    for (int i = 0; i < count; ++i) {
      weights.push_back({double(random() % 100000) / 1000 + i * 1e-4, 1 + random() % 50});
      heaviest = std::max(heaviest, weights.back().bytes);
    }
    std::sort(weights.begin(), weights.end(),
              [](const Weight& a, const Weight& b) { return a.place_m < b.place_m; });
    const ByteCount limit = heaviest + random() % 200;
    const auto cuts = choose_cuts(weights, limit, 0);

    // Greedy from the left is the fewest possible.
    std::size_t fewest = 1;
    ByteCount sum = 0;
    for (const Weight& weight : weights) {
      if (weight.bytes > limit - sum) {
        ++fewest;
        sum = 0;
      }
      sum += weight.bytes;
    }
    EXPECT_EQ(cuts.size() + 1, fewest);

    std::size_t next = 0;
    for (std::size_t slab = 0; slab <= cuts.size(); ++slab) {
      ByteCount bytes = 0;
      while (next < weights.size() &&
             (slab == cuts.size() || weights[next].place_m <= cuts[slab].from_m)) {
        bytes += weights[next++].bytes;
      }
      EXPECT_LE(bytes, limit);
      EXPECT_GT(bytes, 0u);
    }
    EXPECT_EQ(next, weights.size());
  }
}

}  // namespace
}  // namespace zonepack::packer
