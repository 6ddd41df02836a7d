// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/hamming.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace zonepack::localize {
namespace {

TEST(Hamming, CountsTheBitsThatDiffer) {
  // 0xFF and 0x0F differ in 4 bits, 0x01 and 0x80 in 2, equal bytes in none; nine bytes use the
  // loop over words and the one over bytes.
  const std::uint8_t a[9] = {0xFF, 0x01, 7, 7, 7, 7, 7, 7, 0xFF};
  const std::uint8_t b[9] = {0x0F, 0x80, 7, 7, 7, 7, 7, 7, 0x00};
  EXPECT_EQ(hamming_plain(a, b, 9), 4u + 2u + 8u);
}

TEST(Hamming, GivesTheSameWithWhatThisProcessorHas) {
  std::mt19937 random(7);
  for (const std::size_t bytes : {std::size_t{32}, std::size_t{64}, std::size_t{31}}) {
    std::vector<std::uint8_t> one(bytes), rows(bytes * 101);
    for (std::uint8_t& byte : one) byte = static_cast<std::uint8_t>(random());
    for (std::uint8_t& byte : rows) byte = static_cast<std::uint8_t>(random());
    std::copy(one.begin(), one.end(), rows.begin() + static_cast<std::ptrdiff_t>(bytes));
    for (std::size_t i = 0; i < bytes; ++i) rows[i] = static_cast<std::uint8_t>(~one[i]);
    std::vector<std::uint16_t> plain(101), fast(101);
    hamming_rows_plain(one.data(), rows.data(), 101, bytes, plain.data());
    hamming_rows(one.data(), rows.data(), 101, bytes, fast.data());
    EXPECT_EQ(plain, fast) << hamming_kind() << ", " << bytes << " bytes";
    EXPECT_EQ(plain[0], 8 * bytes);  // every bit differs
    EXPECT_EQ(plain[1], 0);
  }
}

}  // namespace
}  // namespace zonepack::localize
