// SPDX-License-Identifier: Apache-2.0
#include "platform/base/natural_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace zonepack {
namespace {

TEST(NaturalOrder, ComparesRunsOfDigitsAsNumbers) {
  std::vector<std::string> names{"room10", "hall.10", "room2", "hall", "hall.9", "room1b", "room1"};
  std::ranges::sort(names, natural_less);
  EXPECT_EQ(names, (std::vector<std::string>{"hall", "hall.9", "hall.10", "room1", "room1b",
                                             "room2", "room10"}));
}

TEST(NaturalOrder, IsTotalWhereOnlyLeadingZerosDiffer) {
  EXPECT_NE(natural_less("a01", "a1"), natural_less("a1", "a01"));
  EXPECT_FALSE(natural_less("a01", "a01"));
  EXPECT_TRUE(natural_less("a01", "a2"));
  EXPECT_TRUE(natural_less("a1", "a02"));
}

TEST(NaturalOrder, TakesNumbersOfAnyLength) {
  const std::string nines(60, '9');
  EXPECT_TRUE(natural_less("r" + nines, "r1" + std::string(60, '0')));
  EXPECT_FALSE(natural_less("r1" + std::string(60, '0'), "r" + nines));
}

TEST(NaturalOrder, ComparesTheRestByBytes) {
  EXPECT_TRUE(natural_less("B", "a"));         // 0x42 < 0x61
  EXPECT_TRUE(natural_less("z", "\xC3\xA9"));  // 0x7a < 0xc3
  EXPECT_TRUE(natural_less("room", "room1"));
  EXPECT_TRUE(natural_less("1room", "room"));  // 0x31 < 0x72
}

}  // namespace
}  // namespace zonepack
