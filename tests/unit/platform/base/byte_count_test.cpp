// SPDX-License-Identifier: Apache-2.0
#include "platform/base/byte_count.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

TEST(ByteCount, ReadsIntegersAndBinarySuffixes) {
  EXPECT_EQ(parse_byte_count("0"), 0u);
  EXPECT_EQ(parse_byte_count("8388609"), 8388609u);
  EXPECT_EQ(parse_byte_count("8KiB"), 8192u);
  EXPECT_EQ(parse_byte_count("8MiB"), 8388608u);
  EXPECT_EQ(parse_byte_count("2GiB"), 2147483648u);
}

TEST(ByteCount, ReadsSizesAsPeopleWriteThem) {
  EXPECT_EQ(parse_byte_count("8M"), 8388608u);
  EXPECT_EQ(parse_byte_count("8K"), 8192u);
  EXPECT_EQ(parse_byte_count("8k"), 8192u);
  EXPECT_EQ(parse_byte_count("2G"), 2147483648u);
  EXPECT_EQ(parse_byte_count("50MB"), 50'000'000u);
  EXPECT_EQ(parse_byte_count("5kB"), 5'000u);
  EXPECT_EQ(parse_byte_count("1GB"), 1'000'000'000u);
  EXPECT_EQ(parse_byte_count("64B"), 64u);
  EXPECT_EQ(parse_byte_count("8 MiB"), 8388608u);
  EXPECT_EQ(parse_byte_count("6.8MiB"), 7130316u);  // 7130316.8
  EXPECT_EQ(parse_byte_count("0.5G"), 536870912u);
  EXPECT_EQ(parse_byte_count("1.5MB"), 1'500'000u);
  EXPECT_EQ(parse_byte_count("8589934591.999999999GiB"), 9223372036854775806u);
}

TEST(ByteCount, RefusesEverythingElse) {
  for (const char* text : {"",
                           "KiB",
                           "-1",
                           "+1",
                           " 1",
                           "1 ",
                           "1kib",
                           "1KiBKiB",
                           "0x10",
                           "1.5",
                           "1.5B",
                           ".5MiB",
                           "1.MiB",
                           "1,5MiB",
                           "1e3",
                           "1MiBs",
                           "8  MiB",
                           "1.0000000001MiB",
                           "1Mb",
                           "1m",
                           "9223372036854775808",
                           "8589934592GiB",
                           "18446744073709551616"}) {
    EXPECT_EQ(parse_byte_count(text), std::nullopt) << text;
  }
}

TEST(ByteCount, PrintsTheShortestExactForm) {
  EXPECT_EQ(format_byte_count(0), "0");
  EXPECT_EQ(format_byte_count(1536), "1536");
  EXPECT_EQ(format_byte_count(2 * kMiB), "2MiB");
  EXPECT_EQ(format_byte_count(3 * kGiB), "3GiB");
}

TEST(ByteCount, RoundsForTables) {
  EXPECT_EQ(short_bytes(0), "0 B");
  EXPECT_EQ(short_bytes(1023), "1023 B");
  EXPECT_EQ(short_bytes(20'480), "20 KiB");
  EXPECT_EQ(short_bytes(1'048'575), "1.00 MiB");  // never "1024 KiB"
  EXPECT_EQ(short_bytes(1'572'864), "1.50 MiB");
}

}  // namespace
}  // namespace zonepack
