// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/floor_plan_dots.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/count_of.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

FloorPlan room_with_dots() {
  FloorPlan plan;
  plan.zones.push_back(
      {.name = "A", .note = "", .hint = "", .polygon = {{{0, 0}, {10, 0}, {10, 8}, {0, 8}}, {}}});
  plan.dots.push_back({.name = "other", .color = kOther, .ring = true, .dots = {{{1, 1}, 2, "r"}}});
  plan.dots.push_back({.name = "fix",
                       .color = kOurs,
                       .ring = false,
                       .dots = {{{2, 3}, 0.5, "a<b"}, {{std::nan(""), 3}, 1, "nowhere"}}});
  return plan;
}

TEST(FloorPlanDots, CarryTheirMomentAndTheirHint) {
  const std::string text = draw_floor_plan(room_with_dots()).file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  EXPECT_EQ(count_of(text, "data-t=\"500\""), 1U);   // 0.5 s
  EXPECT_EQ(count_of(text, "data-t=\"2000\""), 1U);  // 2 s
  EXPECT_EQ(count_of(text, "<title>a&lt;b</title>"), 1U);
  // A dot without a place is counted in the legend and not drawn.
  EXPECT_EQ(count_of(text, "nowhere"), 0U);
  EXPECT_EQ(count_of(text, ">fix (2)<"), 1U);
  EXPECT_EQ(count_of(text, ">other (1)<"), 1U);
}

TEST(FloorPlanDots, LieAboveThoseOfEarlierLayers) {
  const std::string text = draw_floor_plan(room_with_dots()).file_text();
  EXPECT_LT(text.find("data-t=\"2000\""), text.find("data-t=\"500\""));
}

TEST(FloorPlanDots, AreSmallerOnAPhone) {
  // Radius 3, and half of it.
  EXPECT_EQ(count_of(draw_floor_plan(room_with_dots()).file_text(), "r=\"3\""), 1U);
  EXPECT_EQ(count_of(draw_floor_plan(narrowed(room_with_dots())).file_text(), "r=\"1.5\""), 1U);
}

TEST(FloorPlanDots, OfNoneTheDrawingHoldsNothing) {
  FloorPlan plan = room_with_dots();
  plan.dots.clear();
  // One clip for zones and routes; an empty one for dots and faults would be a second.
  EXPECT_EQ(count_of(draw_floor_plan(plan).file_text(), "overflow=\"hidden\""), 1U);
}

}  // namespace
}  // namespace zonepack::report
