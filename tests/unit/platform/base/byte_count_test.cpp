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

TEST(ByteCount, RefusesEverythingElse) {
  for (const char* text :
       {"", "KiB", "-1", "+1", " 1", "1 ", "1.5MiB", "1MB", "1kib", "1KiBKiB", "0x10",
        "9223372036854775808", "8589934592GiB", "18446744073709551616"}) {
    EXPECT_EQ(parse_byte_count(text), std::nullopt) << text;
  }
}

TEST(ByteCount, PrintsTheShortestExactForm) {
  EXPECT_EQ(format_byte_count(0), "0");
  EXPECT_EQ(format_byte_count(1536), "1536");
  EXPECT_EQ(format_byte_count(2 * kMiB), "2MiB");
  EXPECT_EQ(format_byte_count(3 * kGiB), "3GiB");
}

}  // namespace
}  // namespace zonepack
