// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/zlib_blob.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/support/blob_writer.hpp"

namespace zonepack::packer {
namespace {

using test_support::bytes_of;
using test_support::float_matrix;
using test_support::zip;

const std::string kZlibFile = "map.db";
const CellPlace kZlibPlace{.file = &kZlibFile, .signature = 7, .column = "Data.scan"};

Bytes with_trailer(Bytes stream, std::int32_t rows, std::int32_t cols, std::int32_t type) {
  const Bytes trailer = bytes_of(std::vector<std::int32_t>{rows, cols, type});
  stream.insert(stream.end(), trailer.begin(), trailer.end());
  return stream;
}

TEST(MatrixUnpacker, GivesBackWhatWasZippedAndReusesTheMatrix) {
  MatrixUnpacker unpacker;
  Matrix out;
  for (const std::int32_t cols : {100, 3, 0, 50}) {
    const Matrix in =
        float_matrix(1, cols, 2, std::vector<float>(static_cast<std::size_t>(cols) * 2, 2.5f));
    unpacker.unpack(zip(in), kZlibPlace, out);
    EXPECT_EQ(out.rows, 1);
    EXPECT_EQ(out.cols, cols);
    EXPECT_EQ(out.type, 13);  // 5 (float32) + 8 * (2 channels - 1)
    EXPECT_EQ(out.data, in.data);
  }
}

TEST(MatrixUnpacker, GoesOnAfterDamage) {
  MatrixUnpacker unpacker;
  Matrix out;
  const Matrix in = float_matrix(1, 10, 1, std::vector<float>(10, 1.0f));
  Bytes blob = zip(in);
  blob[4] ^= std::byte{0xff};
  EXPECT_THROW(unpacker.unpack(blob, kZlibPlace, out), DamagedSignature);
  unpacker.unpack(zip(in), kZlibPlace, out);
  EXPECT_EQ(out.data, in.data);
}

TEST(MatrixUnpacker, TakesNoMemoryForASizeThatCannotBe) {
  MatrixUnpacker unpacker;
  Matrix out;
  // 2^31 - 1 squared elements would overflow 64 bits times 4096; 256 MiB is the limit; and 100
  // bytes of deflate hold at most 100 * 1032 bytes.
  for (const auto& [rows, cols, type] : std::vector<std::array<std::int32_t, 3>>{
           {2147483647, 2147483647, 0xffe}, {1, 268435457, 0}, {1, 200000000, 0}, {1, 200000, 0}}) {
    EXPECT_THROW(unpacker.unpack(with_trailer(Bytes(100), rows, cols, type), kZlibPlace, out),
                 DamagedSignature);
    EXPECT_EQ(out.data.capacity(), 0u);
  }
}

TEST(MatrixUnpacker, NamesTheFileOnlyWhereNoSignatureIsToBlame) {
  MatrixUnpacker unpacker;
  Matrix out;
  try {
    unpacker.unpack(Bytes(3), {&kZlibFile, 0, "Admin.opt_ids"}, out);
    FAIL();
  } catch (const DamagedSignature&) {
    FAIL() << "blamed signature 0";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).find("map.db: Admin.opt_ids: expected"), 0u);
  }
}

TEST(OpenCvTypes, HaveTheSizesOfOpenCv) {
  EXPECT_EQ(element_bytes(0), 1u);              // CV_8UC1
  EXPECT_EQ(element_bytes(16), 3u);             // CV_8UC3
  EXPECT_EQ(element_bytes(4), 4u);              // CV_32SC1
  EXPECT_EQ(element_bytes(13), 8u);             // CV_32FC2
  EXPECT_EQ(element_bytes(6 + (6 << 3)), 56u);  // CV_64FC7
  EXPECT_EQ(element_bytes(7), 0u);              // float16 of later OpenCV: not in these databases
  EXPECT_EQ(element_bytes(-3), 0u);
  EXPECT_EQ(element_bytes(1 << 12), 0u);
  EXPECT_EQ(describe_type(13), "2 x float32");
}

}  // namespace
}  // namespace zonepack::packer
