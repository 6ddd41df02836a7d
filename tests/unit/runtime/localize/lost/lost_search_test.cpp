// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/lost_search.hpp"

#include <gtest/gtest.h>

#include "tests/unit/runtime/localize/lost/made_places.hpp"

namespace zonepack::localize {
namespace {

// The wheels' frame is at (10, 5) in the map, unturned: wheels at x see the place (10 + x, 5).
class LostSearchTest : public testing::Test {
 protected:
  void at(std::uint64_t number, double x_m, int distinct, int visible = 50, double off_m = 0) {
    search.add(made_view(number, x_m));
    places.guesses[{number, 0}] = {made_sight({10 + x_m + off_m, 5, 0}, distinct, visible)};
  }
  bool found() {
    search.match(0, {});
    const auto place = search.leading();
    return place && search.found(*place);
  }
  // Three views that show the place, and two in which 5 features agree of 100 near points of the
  // map, where so many of the 100 were expected to.
  void three_for_and_two_with(int expected) {
    at(1, 0, 20);
    at(2, 0.2, 20);
    at(3, 0.4, 20);
    for (std::uint64_t i = 4; i <= 5; ++i) {
      const double x_m = 0.2 * static_cast<double>(i - 1);
      search.add(made_view(i, x_m));
      Sight sight = made_sight({10 + x_m, 5, 0}, 5, 100, false);
      sight.expected = expected;
      places.second[{i, 0}] = {sight};
    }
  }
  MadePlaces places;
  LostSearch search{places};
};

// 20 inliers of 50: 20 - 0.12 * 50 = 14 each; three are 42, over 36; 0.4 m lie between the ends.
TEST_F(LostSearchTest, BelievesThreeViewsThatAgreeWhileTheRobotMoved) {
  at(1, 0, 20);
  at(2, 0.2, 20);
  EXPECT_FALSE(found());
  at(3, 0.4, 20);
  EXPECT_TRUE(found());
  const auto place = search.leading();
  EXPECT_NEAR(place->T_map_wheels.x_m, 10, 1e-9);
  EXPECT_NEAR(place->T_map_wheels.y_m, 5, 1e-9);
  EXPECT_NEAR(place->support, 42, 1e-9);
  EXPECT_NEAR(place->moved_m, 0.4, 1e-9);
}

// 17 - 6 = 11 each: 33.
TEST_F(LostSearchTest, WaitsWhereThreeViewsShowTooLittle) {
  at(1, 0, 17);
  at(2, 0.2, 17);
  at(3, 0.4, 17);
  EXPECT_FALSE(found());
}

TEST_F(LostSearchTest, NeverBelievesOneView) {
  at(1, 0, 300, 400);
  EXPECT_FALSE(found());
}

// 100 - 24 = 76 each, far over 36, but only 0.2 m apart, or turned only.
TEST_F(LostSearchTest, BelievesTwoViewsOnlyFromPlacesThatAreApart) {
  at(1, 0, 100, 200);
  at(2, 0.2, 100, 200);
  EXPECT_FALSE(found());
  search.restart();
  search.add(made_view(3, 0, 0));
  search.add(made_view(4, 0, 0.5));
  places.guesses[{3, 0}] = {made_sight({10, 5, 0}, 100, 200)};
  places.guesses[{4, 0}] = {made_sight({10, 5, 0.5}, 100, 200)};
  EXPECT_FALSE(found());
  search.restart();
  at(5, 0, 100, 200);
  at(6, 0.4, 100, 200);
  EXPECT_TRUE(found());
}

// The second is 0.6 m from where the wheels say; 0.25 m and 5 % of 0.2 m are allowed.
TEST_F(LostSearchTest, JoinsOnlyViewsThatAgreeThroughTheWheels) {
  at(1, 0, 20);
  at(2, 0.2, 20, 50, 0.6);
  at(3, 0.4, 20);
  EXPECT_FALSE(found());
  EXPECT_EQ(search.leading()->views.size(), 2u);
}

// Elsewhere, the same views show 11, 11 and 11 more inliers than chance: 33 of 42 are over 0.6.
TEST_F(LostSearchTest, WaitsWhileAnotherPlaceFitsNearlyAsWell) {
  for (std::uint64_t i = 1; i <= 3; ++i) {
    const double x_m = 0.2 * static_cast<double>(i);
    at(i, x_m, 20);
    places.guesses[{i, 1}] = {made_sight({30 + x_m, 5, 0}, 17, 50)};
  }
  search.match(1, {});
  EXPECT_FALSE(found());
  EXPECT_NEAR(search.leading()->rival, 33, 1e-9);
}

// Each of the two views that should see the place costs 8: 42 - 16 = 26.
TEST_F(LostSearchTest, CountsViewsThatShouldSeeThePlaceAndDoNotAgainstIt) {
  three_for_and_two_with(100);
  EXPECT_FALSE(found());
  EXPECT_EQ(search.leading()->against, 2);
  EXPECT_NEAR(search.leading()->support, 26, 1e-9);
}

TEST_F(LostSearchTest, CountsNoViewAgainstAPlaceThatTheMapShowsFromElsewhere) {
  three_for_and_two_with(20);
  EXPECT_TRUE(found());
  EXPECT_EQ(search.leading()->against, 0);
}

// By brute force only the first shows the place; looked at again, so do the others.
TEST_F(LostSearchTest, LooksAgainWhereTheWheelsSayThatTheOthersWere) {
  at(1, 0, 30);
  for (std::uint64_t i = 2; i <= 3; ++i) {
    const double x_m = 0.2 * static_cast<double>(i - 1);
    search.add(made_view(i, x_m));
    places.second[{i, 0}] = {made_sight({10 + x_m, 5, 0}, 25, 50)};
  }
  EXPECT_TRUE(found());
}

TEST_F(LostSearchTest, MatchesAViewWithAZoneOnce) {
  at(1, 0, 20);
  EXPECT_EQ(search.unmatched(0), 1u);
  search.match(0, {});
  EXPECT_EQ(search.unmatched(0), 0u);
  EXPECT_EQ(search.unmatched(7), 1u);
  search.match(0, {});
  EXPECT_EQ(places.looks, 1);
}

// 5 cm and 2 degrees farther it shows the same; 5 degrees are 0.0873 rad.
TEST_F(LostSearchTest, KeepsAViewOnlyWhenItShowsSomethingElse) {
  EXPECT_TRUE(search.add(made_view(1, 0)));
  EXPECT_FALSE(search.add(made_view(2, 0.05, 0.035)));
  EXPECT_TRUE(search.add(made_view(3, 0.05, 0.09)));
  EXPECT_EQ(search.views().size(), 2u);
}

TEST_F(LostSearchTest, LetsTheOldestGoThatSupportsNothing) {
  at(1, 0, 20);
  search.match(0, {});
  for (std::uint64_t i = 2; i <= LostSearch::kMostViews + 3; ++i) {
    search.add(made_view(i, 0.2 * static_cast<double>(i - 1)));
  }
  EXPECT_EQ(search.views().size(), LostSearch::kMostViews);
  EXPECT_EQ(search.views()[0].number, 1u);  // it shows a place
  EXPECT_EQ(search.views()[1].number, 5u);  // 2, 3 and 4 went
}

}  // namespace
}  // namespace zonepack::localize
