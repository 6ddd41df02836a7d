// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/image_blob.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/blob_writer.hpp"

namespace zonepack::packer {
namespace {

using test_support::bytes_of;
using test_support::rvl;

const std::string kFile = "map.db";
const Place kPlace{&kFile, 7, "Data.depth"};

bool depth_passes(const Bytes& bytes) {
  try {
    check_depth(bytes, kPlace);
    return true;
  } catch (const DamagedSignature&) {
    return false;
  }
}

Bytes rvl_words(std::uint32_t width, std::uint32_t height,
                const std::vector<std::uint32_t>& words) {
  Bytes bytes = rvl(width, height, {});
  const Bytes body = bytes_of(words);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

TEST(DepthImages, OfEveryEncodingPass) {
  const std::vector<std::uint16_t> depth_mm = {0, 0, 500, 65535, 1, 0};
  EXPECT_TRUE(depth_passes({}));
  EXPECT_TRUE(depth_passes(rvl(3, 2, depth_mm)));
  EXPECT_TRUE(depth_passes(test_support::depth_png_16(3, 2, depth_mm)));
  EXPECT_TRUE(depth_passes(test_support::depth_png_float(3, 2, std::vector<float>(6, 1.5f))));
  EXPECT_TRUE(depth_passes(test_support::jpeg("right image")));
}

TEST(DepthImages, OfInverseDepthAreLookedInto) {
  Bytes inverse(16, std::byte{0});
  const std::string magic = "DEPTHINV";
  std::copy_n(reinterpret_cast<const std::byte*>(magic.data()), 8, inverse.begin());
  EXPECT_FALSE(depth_passes(inverse));
  const Bytes inner = rvl(2, 1, {7, 8});
  inverse.insert(inverse.end(), inner.begin(), inner.end());
  EXPECT_TRUE(depth_passes(inverse));
  EXPECT_FALSE(depth_passes(Bytes(inverse.begin(), inverse.end() - 4)));
}

TEST(DepthImages, OfRvlMustGiveEveryPixel) {
  // One word, high nibble first: 2 zeros, 2 deltas, then 4 (+2) and 1 (-1), padding.
  EXPECT_TRUE(depth_passes(rvl_words(4, 1, {0x22410000})));
  EXPECT_FALSE(depth_passes(rvl_words(5, 1, {0x22410000})));  // then 0 zeros, 0 deltas: no progress
  EXPECT_FALSE(depth_passes(rvl_words(3, 1, {0x22410000})));  // runs past the last pixel
  EXPECT_FALSE(depth_passes(rvl_words(4, 1, {})));
  EXPECT_FALSE(depth_passes(rvl_words(4, 1, {0xffffffff, 0xffffffff})));  // a number without end
  EXPECT_FALSE(depth_passes(rvl_words(1u << 31, 2, {0x22410000})));
  EXPECT_TRUE(depth_passes(rvl_words(0, 0, {})));
}

TEST(DepthImages, OfRvlAreDamagedWhereverTheyAreCut) {
  const Bytes whole = rvl(8, 8, std::vector<std::uint16_t>(64, 4000));
  ASSERT_TRUE(depth_passes(whole));
  // Whole words only: a cut inside the last one may leave all the pixels' nibbles.
  for (std::size_t size = 8; size + 4 <= whole.size(); size += 4) {
    EXPECT_FALSE(
        depth_passes(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))))
        << size;
  }
}

TEST(Pngs, AreDamagedByAnyCutOrFlippedBit) {
  const Bytes whole = test_support::png(3, 3, 8, 2, Bytes(27, std::byte{9}));
  check_image(whole, kPlace);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(check_image(part, kPlace), DamagedSignature) << size;
  }
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    Bytes flipped = whole;
    flipped[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    EXPECT_THROW(check_image(flipped, kPlace), DamagedSignature) << bit;
  }
}

TEST(Jpegs, MayBePaddedButNotCut) {
  Bytes jpeg = test_support::jpeg("x");
  check_image(jpeg, kPlace);
  EXPECT_THROW(check_image(Bytes(jpeg.begin(), jpeg.end() - 1), kPlace), DamagedSignature);
  jpeg.insert(jpeg.end(), 5, std::byte{0});
  check_image(jpeg, kPlace);
}

}  // namespace
}  // namespace zonepack::packer
