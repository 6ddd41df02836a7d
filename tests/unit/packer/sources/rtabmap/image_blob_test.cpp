// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/image_blob.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/blob_writer.hpp"

namespace zonepack::packer {
namespace {

using test_support::rvl;

const std::string kFile = "map.db";
const CellPlace kPlace{.file = &kFile, .signature = 7, .column = "Data.depth"};

bool depth_passes(const Bytes& bytes) {
  try {
    check_depth(bytes, kPlace);
    return true;
  } catch (const DamagedSignature&) {
    return false;
  }
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
}

TEST(DepthImages, OfAnotherKindAreDamaged) {
  EXPECT_FALSE(depth_passes(Bytes(20, std::byte{'x'})));
  const Bytes whole = rvl(2, 1, {7, 8});
  EXPECT_FALSE(depth_passes(Bytes(whole.begin(), whole.begin() + 15)));  // no size
}

TEST(Images, AreJpegOrPng) {
  check_image({}, kPlace);
  check_image(test_support::jpeg("x"), kPlace);
  check_image(test_support::png(3, 3, 8, 2, Bytes(27, std::byte{9})), kPlace);
  EXPECT_THROW(check_image(rvl(2, 1, {7, 8}), kPlace), DamagedSignature);
  EXPECT_THROW(check_image(Bytes(1, std::byte{0xff}), kPlace), DamagedSignature);
}

}  // namespace
}  // namespace zonepack::packer
