// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/floor_plan_marks.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/count_of.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

FloorPlan one_room(double width, double height) {
  FloorPlan plan;
  plan.zones.push_back({.name = "A",
                        .note = "",
                        .hint = "",
                        .polygon = {{{0, 0}, {width, 0}, {width, height}, {0, height}}, {}}});
  return plan;
}

TEST(FloorPlanMarks, HoldTheGridInsideTheDrawing) {
  FloorPlan plan = one_room(10, 8);
  plan.raster = PlanRaster{"abc", {{0, 0}, {10, 8}}};
  const std::string text = draw_floor_plan(plan).file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  // "abc" is YWJj in base64 (RFC 4648).
  EXPECT_NE(text.find("href=\"data:image/png;base64,YWJj\""), text.npos);
  EXPECT_EQ(text.find("matrix("), text.npos);
  EXPECT_NE(text.find(">occupied<"), text.npos);
}

TEST(FloorPlanMarks, TurnTheGridWithTheMap) {
  FloorPlan plan = one_room(5, 20);  // turned: right is +y, down is +x
  plan.raster = PlanRaster{"abc", {{0, 0}, {5, 20}}};
  const std::string text = draw_floor_plan(plan).file_text();
  EXPECT_NE(text.find("transform=\"matrix(0 1 -1 0 "), text.npos);
}

TEST(FloorPlanMarks, LeaveTheGridsLightnessToThePage) {
  FloorPlan plan = one_room(10, 8);
  plan.raster = PlanRaster{"abc", {{0, 0}, {10, 8}}};
  EXPECT_EQ(count_of(draw_floor_plan(plan).file_text(), "<image class=\"ground\""), 1U);
  Svg photo(10, 10);
  photo.image({0, 0}, 10, 10, false, "abc");
  EXPECT_EQ(count_of(photo.file_text(), "class=\"ground\""), 0U);
}

TEST(FloorPlanMarks, StandUprightOnAPhone) {
  const FloorPlan tall = one_room(5, 20);
  EXPECT_EQ(count_of(draw_floor_plan(tall).file_text(), "down: x"), 1U);
  EXPECT_EQ(count_of(draw_floor_plan(narrowed(tall)).file_text(), "up: y"), 1U);
}

TEST(FloorPlanMarks, DrawFaultsAndOrphansInRedWithNumbers) {
  FloorPlan plan = one_room(10, 8);
  const std::size_t before = count_of(draw_floor_plan(plan).file_text(), to_hex(kLimit));
  EXPECT_EQ(before, 0u);
  plan.faults.push_back({.number = "1",
                         .hint = "overlap",
                         .areas = {{{1, 1}, {2, 1}, {2, 2}}},
                         .lines = {},
                         .points = {}});
  plan.faults.push_back({.number = "2",
                         .hint = "door",
                         .areas = {},
                         .lines = {{{0, 0}, {0, 1}}},
                         .points = {{3, 3}}});
  plan.orphans.push_back({{5, 5}, "signature 7"});
  const std::string text = draw_floor_plan(plan).file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  // Area and its outline, a line, a place, two numbers, the orphan, and two marks of the legend.
  EXPECT_EQ(count_of(text, to_hex(kLimit)), 9u);
  EXPECT_NE(text.find(">2</text>"), text.npos);
  EXPECT_NE(text.find("<title>signature 7</title>"), text.npos);
}

}  // namespace
}  // namespace zonepack::report
