// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/voxel_encoder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <random>
#include <vector>

#include "runtime/pack_format/column.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

using Value = std::function<std::uint32_t(std::uint32_t voxel, std::uint32_t plane)>;

Bytes block_of(std::uint32_t planes, const Value& value) {
  Bytes blob(bytes_of_block(planes));
  for (std::uint32_t i = 0; i < kVoxelsOfBlock; ++i) {
    for (std::uint32_t p = 0; p < planes; ++p) {
      const std::uint32_t bits = value(i, p);
      std::memcpy(blob.data() + (i * planes + p) * 4, &bits, 4);
    }
  }
  return blob;
}

struct Encoded {
  Bytes bytes;  // and padding
  std::size_t size;
  ByteSpan span() const { return ByteSpan(bytes).first(size); }
};

Encoded encoded(const Bytes& blob, std::uint32_t planes) {
  Encoded out;
  encode_block(blob, planes, out.bytes);
  out.size = out.bytes.size();
  out.bytes.resize(out.size + kColumnPadding);
  return out;
}

// Every voxel of every plane, one by one and all at once; the size.
std::size_t comes_back(std::uint32_t planes, const Value& value) {
  const Bytes blob = block_of(planes, value);
  const Encoded block = encoded(blob, planes);
  Bytes again(blob.size());
  EXPECT_TRUE(copy_block(block.span(), planes, again));
  EXPECT_EQ(again, blob);
  VoxelPlanes parsed;
  EXPECT_TRUE(parse_block(block.span(), planes, parsed));
  for (std::uint32_t p = 0; p < planes; ++p) {
    EXPECT_TRUE(parsed[p].is_exact());
    for (std::uint32_t i = 0; i < kVoxelsOfBlock; ++i) {
      if (parsed[p].at(i) != value(i, p)) {
        ADD_FAILURE() << "voxel " << i << " of plane " << p;
        return block.size;
      }
    }
  }
  return block.size;
}

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

// 512 floats in [-0.2, 0.2) with random mantissas.
std::vector<std::uint32_t> noise() {
  std::mt19937_64 engine(5);
  std::vector<std::uint32_t> out(kVoxelsOfBlock);
  for (std::uint32_t& value : out) {
    value = bits((static_cast<float>(engine() >> 40) / 16777216.0F - 0.5F) * 0.4F);
  }
  return out;
}

TEST(VoxelEncoder, StoresWhatIsTheSameEverywhereAsOneNumber) {
  // how, form, value: 1 + 1 + 4 bytes a plane.
  EXPECT_EQ(comes_back(2, [](auto, auto p) { return p == 0 ? bits(0.2F) : bits(5.0F); }), 12u);
}

TEST(VoxelEncoder, StoresColumnsOnce) {
  // 64 values by a choice of one of two: 2 + constant 4 + bitmap 8 + the other 4 = 18 bytes.
  EXPECT_EQ(comes_back(1, [](auto i, auto) { return i / 8 % 2 == 0 ? 7u : 0xFFFFFF00u; }), 18u);
}

TEST(VoxelEncoder, StoresSmallIntegersInTheirBits) {
  // Scaled: 0 to 511 take 9 bits: 2 + 6 + 512 x 9 / 8 = 584.
  EXPECT_EQ(comes_back(1, [](auto i, auto) { return bits(static_cast<float>(i)); }), 584u);
  // int32 -256 to 255, the same.
  EXPECT_EQ(comes_back(1, [](auto i, auto) { return i - 256u; }), 584u);
}

TEST(VoxelEncoder, StoresNoiseInItsMantissaAndTheNumberOfItsExponent) {
  const auto values = noise();
  const std::size_t size = comes_back(1, [&](auto i, auto) { return values[i]; });
  EXPECT_LE(size, 2u + 2 + 64 + 512 * 28 / 8);  // up to 32 signs and exponents: 5 bits, and 23
  EXPECT_GT(size, 512u * 23 / 8);
}

TEST(VoxelEncoder, NamesWhatMostVoxelsHaveAndListsTheRest) {
  const auto values = noise();
  // A quarter is noise. Its places are the same in both planes: the second needs no bitmap.
  const std::size_t size = comes_back(2, [&](auto i, auto p) {
    if (i % 4 == 1) return values[(i + p) % 512];
    return p == 0 ? bits(0.2F) : bits(5.0F);
  });
  // One bitmap of 64 bytes, two lists of 128 values of at most 27 bits, headers of up to 42.
  EXPECT_LE(size, 64u + 2 * (128 * 27 / 8 + 42));
}

TEST(VoxelEncoder, SharesTheRunsOfThePlaneBefore) {
  const auto values = noise();
  const std::size_t size = comes_back(2, [&](auto i, auto p) { return values[i / 5 + p * 200]; });
  EXPECT_LE(size, 64u + 2 * (103 * 27 / 8 + 1 + 36));
}

TEST(VoxelEncoder, KeepsColoursByTheirBytes) {
  std::mt19937_64 engine(9);
  std::vector<std::uint32_t> colours(512);
  for (std::uint32_t& c : colours) {
    c = 0xFF000000u | static_cast<std::uint32_t>(100 + engine() % 16) |
        static_cast<std::uint32_t>(60 + engine() % 16) << 8 |
        static_cast<std::uint32_t>(20 + engine() % 16) << 16;
  }
  // Three bytes of 4 bits: 2 + 8 + 512 x 12 / 8 = 778.
  EXPECT_EQ(comes_back(1, [&](auto i, auto) { return colours[i]; }), 778u);
}

TEST(VoxelEncoder, KeepsEveryBitOfNanInfinityMinusZeroAndPadding) {
  static constexpr std::array<std::uint32_t, 8> kOdd = {0x7FC00000u, 0xFFC00001u, 0x7F800001u,
                                                        0x7F800000u, 0xFF800000u, 0x80000000u,
                                                        0x00000001u, 0xDEADBEEFu};
  comes_back(5, [](auto i, auto p) { return kOdd[(i * 7 + p) % kOdd.size()]; });
  std::mt19937_64 engine(1);
  std::vector<std::uint32_t> any(kVoxelsOfBlock * 5);
  for (std::uint32_t& value : any) value = static_cast<std::uint32_t>(engine());
  // Nothing fits: raw, 2 + 2048 bytes a plane.
  EXPECT_EQ(comes_back(5, [&](auto i, auto p) { return any[i * 5 + p]; }), 5u * 2050);
}

TEST(VoxelEncoder, RestoresPlanesOfEveryMixture) {
  std::mt19937_64 engine(33);
  for (int round = 0; round < 300; ++round) {
    const std::uint64_t kinds = 1 + engine() % 40, run = 1 + engine() % 20, mask = engine();
    std::vector<std::uint32_t> values(kVoxelsOfBlock * 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = i % run != 0 && i > 0 ? values[i - 1]
                  : engine() % 3 == 0   ? static_cast<std::uint32_t>(engine() & mask)
                                        : static_cast<std::uint32_t>(engine() % kinds);
    }
    comes_back(3, [&](auto i, auto p) { return values[i + p * kVoxelsOfBlock]; });
  }
}

TEST(VoxelBlock, RefusesEveryBlockThatIsCutOrLonger) {
  const auto values = noise();
  const Encoded block =
      encoded(block_of(2, [&](auto i, auto p) { return i % 4 == 1 ? values[i] : i / 100 + p; }), 2);
  VoxelPlanes planes;
  for (std::size_t size = 0; size < block.size; ++size) {
    EXPECT_FALSE(parse_block(ByteSpan(block.bytes).first(size), 2, planes)) << size;
  }
  EXPECT_TRUE(parse_block(block.span(), 2, planes));
  EXPECT_FALSE(parse_block(ByteSpan(block.bytes).first(block.size + 1), 2, planes));
  EXPECT_FALSE(parse_block(block.span(), 1, planes));
  EXPECT_FALSE(parse_block(block.span(), 6, planes));
}

TEST(VoxelBlock, RefusesWhatRefersToAPlaneBeforeTheFirst) {
  Bytes block = {std::byte{3}, std::byte{0}, {}, {}, {}, {}};
  block.resize(6 + kColumnPadding);
  VoxelPlanes planes;
  EXPECT_FALSE(parse_block(ByteSpan(block).first(6), 1, planes));
  block[0] = std::byte{3 << 2};
  EXPECT_FALSE(parse_block(ByteSpan(block).first(6), 1, planes));
  block[0] = std::byte{0};
  EXPECT_TRUE(parse_block(ByteSpan(block).first(6), 1, planes));
}

TEST(VoxelBlock, PlacesBlocksAlongAZCurve) {
  EXPECT_EQ(place_in_cube(1, 0, 0), 1u);
  EXPECT_EQ(place_in_cube(0, 1, 0), 2u);
  EXPECT_EQ(place_in_cube(0, 0, 1), 4u);
  EXPECT_EQ(place_in_cube(7, 7, 7), 511u);
  for (std::uint32_t place = 0; place < 512; ++place) {
    const auto xyz = xyz_of_place(place);
    EXPECT_EQ(place_in_cube(xyz[0], xyz[1], xyz[2]), place);
  }
}

}  // namespace
}  // namespace zonepack::packer
