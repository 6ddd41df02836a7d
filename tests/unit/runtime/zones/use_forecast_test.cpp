// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/use_forecast.hpp"

#include <gtest/gtest.h>

#include "tests/support/rooms.hpp"

namespace zonepack {
namespace {

using testing_support::box;

constexpr std::int64_t kStay_ns = 1'000'000'000;
constexpr float kOne = UseForecast::kPerZone, kTwo = kOne * kOne;

// Three rooms in a row, each 4 m square: a (x 0 to 4), b, c.
constexpr ZoneId kLeft = 0, kMiddle = 1, kRight = 2;

ZoneGraph row() {
  const GraphPortal portals[] = {{kLeft, kMiddle, {{4, 1}, {4, 3}}},
                                 {kMiddle, kRight, {{8, 1}, {8, 3}}}};
  return ZoneGraph({{"a", box(0, 0, 4, 4)}, {"b", box(4, 0, 8, 4)}, {"c", box(8, 0, 12, 4)}},
                   portals);
}

// Rooms in a ring, each joined to the one before it and the next.
ZoneGraph ring(std::size_t rooms) {
  std::vector<GraphZone> zones;
  std::vector<GraphPortal> portals;
  for (std::size_t i = 0; i < rooms; ++i) {
    const double x = 4.0 * static_cast<double>(i);
    zones.push_back({std::to_string(i), box(x, 0, x + 4, 4)});
    portals.push_back(
        {static_cast<ZoneId>(i), static_cast<ZoneId>((i + 1) % rooms), {{x + 4, 1}, {x + 4, 3}}});
  }
  return ZoneGraph(std::move(zones), portals);
}

class UseForecastTest : public testing::Test {
 protected:
  const ZoneGraph graph = row();
  Transitions transitions{graph};
  UseForecast forecast{transitions};
};

// From a the only way is to b; from there, with nothing learned, to c (straight on, weight 3) or
// back to a (weight 0.25).
TEST_F(UseForecastTest, AZoneIsWorthTheSoonerAndTheLikelierItIsEntered) {
  forecast.begin(kNoZone, kLeft, {});
  EXPECT_FLOAT_EQ(forecast.value(kMiddle), kOne);
  EXPECT_GT(forecast.value(kRight), kTwo * 3 / 3.25F);  // at once, or after going back
  EXPECT_LT(forecast.value(kRight), kTwo);
  EXPECT_GT(forecast.value(kLeft), kTwo * 0.25F / 3.25F);
  EXPECT_LT(forecast.value(kLeft), forecast.value(kRight));
}

TEST_F(UseForecastTest, HabitsChangeTheForecast) {
  for (int i = 0; i < 20; ++i) transitions.learn(kLeft, kMiddle, kLeft, kStay_ns);
  forecast.begin(kNoZone, kLeft, {});
  EXPECT_GT(forecast.value(kLeft), forecast.value(kRight));
}

TEST_F(UseForecastTest, ZonesOfARouteComeInItsOrderAndBeforeWhatIsOnlyLikely) {
  const ZoneId ahead[] = {kMiddle, kLeft, kMiddle};
  forecast.begin(kNoZone, kLeft, ahead);
  EXPECT_FLOAT_EQ(forecast.value(kMiddle), 1 + kOne);
  EXPECT_FLOAT_EQ(forecast.value(kLeft), 1 + kTwo);
  // From the end of the route on, c comes straight on at the earliest, four zones from now.
  EXPECT_LT(forecast.value(kRight), kTwo * kTwo);
  EXPECT_GT(forecast.value(kRight), kTwo * kTwo * 0.9F);
}

TEST_F(UseForecastTest, NothingIsExpectedWhereTheRobotIsInNoZone) {
  forecast.begin(kLeft, kNoZone, {});
  EXPECT_EQ(forecast.value(kLeft), 0);
  EXPECT_TRUE(forecast.finished());
}

TEST_F(UseForecastTest, ValuesDoNotDependOnHowTheWorkIsSpread) {
  UseForecast spread(transitions);
  forecast.begin(kNoZone, kLeft, {});
  spread.begin(kNoZone, kLeft, {});
  int parts = 0;
  for (; !spread.finished(); ++parts) spread.advance();
  for (const ZoneId zone : {kLeft, kMiddle, kRight})
    EXPECT_EQ(spread.value(zone), forecast.value(zone));
  // 5 states (a from nowhere; b from a; a, c from b; b from c) by four, 60 steps by two.
  EXPECT_EQ(parts, 2 + 60 / 2);
}

TEST(UseForecast, OfALargeMapOnlyWhatIsNearIsForecast) {
  const ZoneGraph graph = ring(1000);
  const Transitions transitions(graph);
  UseForecast forecast(transitions);
  forecast.begin(kNoZone, 500, {});
  EXPECT_GT(forecast.value(501), 0);
  EXPECT_GT(forecast.value(499), 0);
  EXPECT_GT(forecast.value(510), 0);
  EXPECT_EQ(forecast.value(0), 0);
  int parts = 0;
  forecast.begin(kNoZone, 500, {});
  for (; !forecast.finished(); ++parts) forecast.advance();
  EXPECT_LE(parts, 128 / 4 + 60 / 2);
}

}  // namespace
}  // namespace zonepack
