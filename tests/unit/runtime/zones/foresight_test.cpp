// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/foresight.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::three_rooms;

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;

std::vector<ZoneId> zones(const Foresight& foresight) {
  std::vector<ZoneId> list;
  for (const Coming& coming : foresight.coming()) list.push_back(coming.zone);
  return list;
}

TEST(Foresight, LooksSeveralStepsAhead) {
  const ZoneGraph graph = three_rooms();
  Transitions table(graph);
  for (int i = 0; i < 20; ++i) {
    table.learn(kNoZone, 0, 1, 10 * kOneSecond_ns);
    table.learn(0, 1, 2, 20 * kOneSecond_ns);
  }
  Foresight foresight;
  foresight.look(table, kNoZone, 0);
  // b is the only way; c after it, at about 10 + 20 s.
  ASSERT_EQ(zones(foresight), (std::vector<ZoneId>{1, 2}));
  EXPECT_FLOAT_EQ(foresight.coming()[0].share, 1);
  EXPECT_FLOAT_EQ(foresight.coming()[0].seconds, 10);
  EXPECT_NEAR(foresight.coming()[1].share, 0.99, 0.01);
  EXPECT_NEAR(foresight.coming()[1].seconds, 30, 0.5);
  EXPECT_GT(foresight.worth(1), foresight.worth(2));
  EXPECT_EQ(foresight.worth(0), 0) << "where the robot is";
}

TEST(Foresight, FollowsARouteInItsOrderAndCountsAZoneOnce) {
  Foresight foresight;
  const std::vector<ZoneId> ahead = {1, 2, 1, 0};
  foresight.follow(ahead, kNoZone, 0, nullptr);
  ASSERT_EQ(zones(foresight), (std::vector<ZoneId>{1, 2, 0}));
  EXPECT_EQ(foresight.coming()[0].share, 1);
  EXPECT_LT(foresight.coming()[1].seconds, foresight.coming()[2].seconds);
  foresight.clear();
  EXPECT_TRUE(foresight.coming().empty());
}

}  // namespace
}  // namespace zonepack
