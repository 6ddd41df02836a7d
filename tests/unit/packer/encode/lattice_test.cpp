// SPDX-License-Identifier: Apache-2.0
// Grid cells as a bitmap and back, bit for bit, or not at all.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "packer/encode/column_encoder.hpp"
#include "runtime/pack_format/column.hpp"

namespace zonepack::packer {
namespace {

std::vector<std::uint32_t> bits_of(const std::vector<float>& values) {
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

std::vector<float> decoded(const EncodedColumn& encoded, std::size_t rows) {
  Bytes bytes = encoded.bytes;
  bytes.resize(bytes.size() + kColumnPadding);
  const fb::Column column(encoded.base, 0, static_cast<std::uint32_t>(encoded.bytes.size()),
                          encoded.param, encoded.field, encoded.codec, encoded.bits);
  EXPECT_TRUE(column_is_sound(column, bytes, static_cast<std::uint32_t>(rows)));
  std::vector<float> values;
  for_each_cell(ColumnView(column, bytes.data(), static_cast<std::uint32_t>(rows)),
                [&](float x, float y) {
                  values.push_back(x);
                  values.push_back(y);
                });
  return values;
}

// About half the cells of a square of 60 x 60, row by row.
std::vector<float> some_cells(float cell, float origin_x, float origin_y, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      if (random() % 2 == 0) continue;
      values.push_back(static_cast<float>(x) * cell + origin_x);
      values.push_back(static_cast<float>(y) * cell + origin_y);
    }
  }
  return values;
}

TEST(Lattice, GivesCellsBackBitForBit) {
  for (const float cell : {0.05f, 0.1f, 0.03125f, 1e-3f, 2.5f}) {
    for (const float steps : {0.0f, -30.0f, 0.37f, -59.99f, 1e4f}) {
      const std::vector<float> values = some_cells(cell, steps * cell, -steps * cell + 0.01f, 5);
      LatticeEncoder lattice;
      const auto encoded = lattice.encode(std::as_bytes(std::span(values)), cell);
      ASSERT_TRUE(encoded.has_value()) << cell << " " << steps;
      EXPECT_LT(encoded->bytes.size(), values.size());  // a bit for each of 3600 cells
      EXPECT_EQ(bits_of(decoded(*encoded, values.size() / 2)), bits_of(values));
    }
  }
}

// Two cells that round to one coordinate cannot be distinguished; the result is still exact.
TEST(Lattice, IsExactOrNothingWhereCellsAreFinerThanFloats) {
  int refused = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const float cell = std::ldexp(0.05f, -static_cast<int>(seed));
    const std::vector<float> values = some_cells(cell, 3.1f, -2.7f, seed);
    LatticeEncoder lattice;
    const auto encoded = lattice.encode(std::as_bytes(std::span(values)), cell);
    if (!encoded) {
      ++refused;
      continue;
    }
    EXPECT_EQ(bits_of(decoded(*encoded, values.size() / 2)), bits_of(values)) << cell;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 20);
}

TEST(Lattice, RefusesWhatIsNoGrid) {
  const std::vector<float> grid = some_cells(0.05f, -1, -1, 3);
  const auto refuses = [](const std::vector<float>& values) {
    LatticeEncoder lattice;
    return !lattice.encode(std::as_bytes(std::span(values)), 0.05f).has_value();
  };
  EXPECT_FALSE(refuses(grid));
  std::vector<float> moved = grid;
  moved[100] = std::nextafter(moved[100], 10.0f);
  EXPECT_TRUE(refuses(moved));
  std::vector<float> swapped = grid;
  std::swap(swapped[0], swapped[2]);
  EXPECT_TRUE(refuses(swapped));
  std::vector<float> twice = grid;
  twice.insert(twice.begin(), grid.begin(), grid.begin() + 2);
  EXPECT_TRUE(refuses(twice));
  std::vector<float> nan = grid;
  nan[4] = std::nanf("");
  EXPECT_TRUE(refuses(nan));
  EXPECT_TRUE(refuses({}));
}

}  // namespace
}  // namespace zonepack::packer
