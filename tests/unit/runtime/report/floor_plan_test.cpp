// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/floor_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runtime/report/plan_label.hpp"
#include "runtime/report/plan_view.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

constexpr double kFloorPlanNaN = std::numeric_limits<double>::quiet_NaN();

Polygon box(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

FloorPlan two_rooms() {
  FloorPlan plan;
  plan.zones.push_back({"L1", "1.2 MiB", "lobby", box(0, 0, 10, 8), ramp_color(1)});
  plan.zones.push_back({"R<1>", "", "", box(10, 0, 16, 8), ramp_color(0)});
  plan.portals.push_back({{10, 3}, {10, 4}});
  plan.signatures = {{2, 2}, {12, 5}};
  plan.route = {{{1, 1}, hue(0)}, {{9, 4}, hue(0)}, {{12, 4}, hue(1)}};
  plan.true_route = {{1, 1.1}, {12, 4.1}};
  plan.ramp = PlanRamp{"0 B", "1.2 MiB"};
  return plan;
}

TEST(PlanView, UsesOneScaleAndPutsNorthUp) {
  // 20 m x 10 m into 400 px x 400 px: 20 px/m.
  const PlanView view({{0, 0}, {20, 10}}, {5, 7}, 400, 400);
  EXPECT_FALSE(view.turned());
  EXPECT_DOUBLE_EQ(view.px_per_m(), 20);
  EXPECT_DOUBLE_EQ(view(Point2{0, 0}).x, 5);
  EXPECT_DOUBLE_EQ(view(Point2{0, 0}).y, 207);
  EXPECT_DOUBLE_EQ(view(Point2{20, 10}).x, 405);
  EXPECT_DOUBLE_EQ(view(Point2{20, 10}).y, 7);
}

TEST(PlanView, TurnsATallMapWithoutMirroringIt) {
  const PlanView view({{-10, -30}, {10, 30}}, {0, 0}, 600, 600);
  EXPECT_TRUE(view.turned());
  EXPECT_DOUBLE_EQ(view.width(), 600);
  EXPECT_DOUBLE_EQ(view.height(), 200);
  const Px o = view(Point2{0, 0}), east = view(Point2{1, 0}), north = view(Point2{0, 1});
  // On a page with y down, east x north must still turn to the left: a negative cross product.
  EXPECT_LT((east.x - o.x) * (north.y - o.y) - (east.y - o.y) * (north.x - o.x), 0);
}

TEST(PlanView, GivesAPointSomeRoom) {
  const PlanView view({{3, 3}, {3, 3}}, {0, 0}, 100, 100);
  EXPECT_TRUE(std::isfinite(view(Point2{3, 3}).x));
}

TEST(PlanLabel, StandsInsideTheAreaAndOffItsHole) {
  const std::vector<std::vector<Px>> rings = {{{0, 0}, {100, 0}, {100, 40}, {0, 40}},
                                              {{30, 0.5}, {70, 0.5}, {70, 39.5}, {30, 39.5}}};
  const auto place = place_label(rings, 20, 10, {});
  ASSERT_TRUE(place.has_value());
  const PxBox label = box_around(place->center, 20, 10);
  EXPECT_TRUE((label.min.x > 0 && label.max.x < 30) || (label.min.x > 70 && label.max.x < 100));
}

TEST(PlanLabel, RefusesAnAreaTooSmallForIt) {
  const std::vector<std::vector<Px>> rings = {{{0, 0}, {100, 0}, {100, 9}, {0, 9}}};
  EXPECT_FALSE(place_label(rings, 20, 10, {}).has_value());
  EXPECT_FALSE(place_label(std::vector<std::vector<Px>>{}, 20, 10, {}).has_value());
}

TEST(PlanLabel, KeepsOffTakenBoxesAndPrefersFreeGround) {
  const std::vector<std::vector<Px>> rings = {{{0, 0}, {100, 0}, {100, 30}, {0, 30}}};
  LabelGround half_taken;
  half_taken.taken = {{{0, 0}, {50, 30}}};
  const auto right = place_label(rings, 20, 10, half_taken);
  ASSERT_TRUE(right.has_value());
  EXPECT_GE(right->center.x - 10, 50);
  LabelGround crossed;
  for (int x = 40; x <= 100; x += 4) crossed.keep.push_back({static_cast<double>(x), 15});
  const auto left = place_label(rings, 20, 10, crossed);
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(left->hidden, 0u);
  EXPECT_LT(left->center.x + 10, 40);
}

TEST(PlanLabel, GivesWayToSignaturesOnlyWhereItCan) {
  const std::vector<std::vector<Px>> rings = {{{0, 0}, {100, 0}, {100, 30}, {0, 30}}};
  LabelGround ground;
  for (int x = 0; x <= 50; x += 5) ground.spare.push_back({static_cast<double>(x), 15});
  const auto right = place_label(rings, 20, 10, ground);
  ASSERT_TRUE(right.has_value());
  EXPECT_GT(right->center.x - 10, 50);
  for (int x = 0; x <= 100; x += 5) ground.spare.push_back({static_cast<double>(x), 15});
  const auto anywhere = place_label(rings, 20, 10, ground);
  ASSERT_TRUE(anywhere.has_value());
  EXPECT_EQ(anywhere->hidden, 0u);
}

TEST(FloorPlan, ShowsZonesPortalsSignaturesAndRoutes) {
  const std::string text = draw_floor_plan(two_rooms()).file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  EXPECT_EQ(count_of(text, ">L1</text>"), 1u);
  EXPECT_EQ(count_of(text, ">R&lt;1&gt;</text>"), 1u);
  EXPECT_EQ(count_of(text, ">1.2 MiB</text>"), 1u);
  EXPECT_EQ(count_of(text, "fill=\"" + to_hex(ramp_color(1)) + "\""), 1u);
  EXPECT_EQ(count_of(text, "opacity=\"0.5\""), 2u);  // two signatures
  EXPECT_EQ(count_of(text, ">true route</text>"), 1u);
  EXPECT_EQ(count_of(text, "<title>start</title>"), 1u);
}

// 20,000 signatures along 16 m, which are at most 1200 px: at most one for each 3 px.
TEST(FloorPlan, OfManySignaturesDrawsOneForEachFewPixels) {
  FloorPlan plan = two_rooms();
  plan.signatures.clear();
  for (int i = 0; i < 20'000; ++i) plan.signatures.push_back({16.0 * i / 20'000, 4});
  const auto drawn = count_of(draw_floor_plan(plan).file_text(), "opacity=\"0.5\"");
  EXPECT_LE(drawn, 401u);
  EXPECT_GE(drawn, 100u);
}

TEST(FloorPlan, ColoursTheRouteByZoneWithoutAGap) {
  const std::string text = draw_floor_plan(two_rooms()).inline_text();
  const auto stretch = [&](Color color) {
    // The last line of this colour; a legend mark may stand before it.
    const std::size_t end = text.rfind("\" fill=\"none\" stroke=\"" + to_hex(color) + "\"");
    const std::size_t begin = text.rfind("points=\"", end) + 8;
    return text.substr(begin, end - begin);
  };
  const std::string first = stretch(hue(0)), second = stretch(hue(1));
  EXPECT_EQ(first.substr(first.rfind(' ') + 1), second.substr(0, second.find(' ')));
}

TEST(FloorPlan, TheSamePlanGivesTheSameBytes) {
  EXPECT_EQ(draw_floor_plan(two_rooms()).file_text(), draw_floor_plan(two_rooms()).file_text());
}

TEST(FloorPlan, DrawsAMapOfOneZoneAndOfNone) {
  FloorPlan one;
  one.zones.push_back({"A", "", "", box(0, 0, 3, 3), kWhite});
  EXPECT_EQ(count_of(draw_floor_plan(one).inline_text(), ">A</text>"), 1u);
  EXPECT_EQ(XmlCheck::problem_in(draw_floor_plan(FloorPlan{}).inline_text()), "");
}

TEST(FloorPlan, LeavesOutWhatIsNotFinite) {
  FloorPlan plan = two_rooms();
  plan.route.insert(plan.route.begin(), {{kFloorPlanNaN, 1}, hue(3)});
  plan.signatures.push_back({kFloorPlanNaN, kFloorPlanNaN});
  plan.true_route.push_back({1, kFloorPlanNaN});
  plan.zones.push_back({"N", "", "", {{{kFloorPlanNaN, 0}, {1, kFloorPlanNaN}}, {}}, kWhite});
  const std::string text = draw_floor_plan(plan).inline_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("\"-\""), std::string::npos);
  EXPECT_EQ(count_of(text, "opacity=\"0.5\""), 2u);
}

TEST(FloorPlan, ARouteFarOutsideTheMapDoesNotShrinkIt) {
  FloorPlan plan = two_rooms();
  const double height = draw_floor_plan(plan).height();
  plan.route.push_back({{1e6, 1e6}, hue(0)});
  EXPECT_DOUBLE_EQ(draw_floor_plan(plan).height(), height);
}

}  // namespace
}  // namespace zonepack::report
