// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/lru_shadow.hpp"

#include <gtest/gtest.h>

namespace zonepack {
namespace {

class LruShadowTest : public testing::Test {
 protected:
  // Slots of the zones 0 to 3; a memory of 10.
  const ZoneNeed needs[4] = {{4, 1}, {4, 1}, {5, 1}, {11, 1}};
  LruShadow shadow{needs, 10};
};

TEST_F(LruShadowTest, AZoneIsLoadedOnceWhileItIsHeld) {
  EXPECT_EQ(shadow.request(0), 4);
  EXPECT_EQ(shadow.request(0), 0);
  EXPECT_TRUE(shadow.holds(0));
}

TEST_F(LruShadowTest, TheLeastRecentlyUsedZoneMakesRoom) {
  shadow.request(0);
  shadow.request(1);
  shadow.request(0);
  EXPECT_EQ(shadow.request(2), 5);  // 4 + 4 + 5 > 10: zone 1 goes
  EXPECT_TRUE(shadow.holds(0));
  EXPECT_FALSE(shadow.holds(1));
  EXPECT_EQ(shadow.request(1), 4);  // zone 0 goes
  EXPECT_FALSE(shadow.holds(0));
}

TEST_F(LruShadowTest, AZoneLargerThanTheMemoryIsNeverHeld) {
  shadow.request(0);
  EXPECT_EQ(shadow.request(3), 0);
  EXPECT_FALSE(shadow.holds(3));
  EXPECT_TRUE(shadow.holds(0));
}

}  // namespace
}  // namespace zonepack
