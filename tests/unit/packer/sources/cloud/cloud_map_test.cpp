// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/cloud_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace zonepack::packer {
namespace {

// A point whose intensity and ring say which it is.
void add(TilePoints& points, float x, float y, float z) {
  const auto number = static_cast<float>(points.size());
  points.x.push_back(x);
  points.y.push_back(y);
  points.z.push_back(z);
  points.intensity.push_back(number);
  points.ring.push_back(number);
}

TEST(SortInBlocks, PutsNeighboursIntoOneBlock) {
  TilePoints points;
  for (int i = 0; i < 4 * 32; ++i) {  // four heaps, in turns
    const auto step = static_cast<float>(i / 4);
    add(points, i % 2 == 0 ? 1 : 9, i % 4 < 2 ? 2 : 7, 1 + 0.001F * step);
  }
  sort_in_blocks(points);
  for (std::size_t block = 0; block < 4; ++block) {
    for (std::size_t i = block * 32; i < block * 32 + 32; ++i) {
      EXPECT_EQ(points.x[i], points.x[block * 32]);
      EXPECT_EQ(points.y[i], points.y[block * 32]);
    }
  }
}

TEST(SortInBlocks, PartsWhatIsNearButFarApartInBits) {
  TilePoints points;
  for (int i = 0; i < 64; ++i) {
    const float x = 0.001F + 0.0001F * static_cast<float>(i / 2);
    add(points, i % 2 == 0 ? x : -x, 5 + 0.01F * static_cast<float>(i), 1);
  }
  sort_in_blocks(points);
  for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(std::signbit(points.x[i]), i < 32);
}

TEST(SortInBlocks, KeepsEveryPointWhole) {
  TilePoints points, before;
  for (int i = 0; i < 1001; ++i) {
    const auto v = static_cast<float>(i * 7919 % 1001);
    add(points, std::sin(v), std::cos(3 * v), v / 100);
  }
  before = points;
  sort_in_blocks(points);
  std::set<float> seen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto was = static_cast<std::size_t>(points.intensity[i]);
    EXPECT_EQ(points.x[i], before.x[was]);
    EXPECT_EQ(points.y[i], before.y[was]);
    EXPECT_EQ(points.z[i], before.z[was]);
    EXPECT_EQ(points.ring[i], points.intensity[i]);
    seen.insert(points.intensity[i]);
  }
  EXPECT_EQ(seen.size(), 1001u);
}

TEST(SortInBlocks, TakesNoneAndOne) {
  TilePoints points;
  sort_in_blocks(points);
  add(points, 1, 2, 3);
  sort_in_blocks(points);
  EXPECT_EQ(points.size(), 1u);
}

}  // namespace
}  // namespace zonepack::packer
