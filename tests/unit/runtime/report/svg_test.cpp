// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/svg.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

constexpr double kSvgNaN = std::numeric_limits<double>::quiet_NaN();

Svg everything() {
  Svg svg(200, 100);
  svg.open_group("a <group>");
  svg.open_clip({10, 10}, 50, 50);
  svg.line({0, 0}, {1.005, 2}, {.stroke = kInk, .dash = "4 3"});
  const std::vector<Px> points = {{0, 0}, {1, 1}, {2, 0}};
  svg.polyline(points, {.stroke = kOurs, .stroke_width = 2.5, .opacity = 0.5, .round = true});
  const std::vector<std::vector<Px>> rings = {{{0, 0}, {9, 0}, {9, 9}}, {{1, 1}, {2, 1}, {2, 2}}};
  svg.polygon(rings, {.fill = kDoor, .hint = "L1 & \"L2\""});
  svg.close();
  svg.close();
  svg.rect({1, 2}, 3, 4, {.fill = kWhite}, 2);
  svg.circle({5, 5}, 2, {.fill = kInk});
  svg.text({5, 5}, "R&D <1>", {.bold = true, .anchor = Anchor::kMiddle, .halo = kWhite});
  return svg;
}

TEST(XmlCheck, FindsWhatIsWrong) {
  EXPECT_EQ(XmlCheck::problem_in("<a b=\"c\"><d/>&amp;</a>"), "");
  EXPECT_EQ(XmlCheck::problem_in("<a><script>1 < 2 && f()</script></a>"), "");
  for (const char* text : {"", "<a>", "<a></b>", "<a b=c/>", "<a>&</a>", "<a/><b/>",
                           "<a b=\"1\" b=\"2\"/>", "<script>1 < 2</a>", "<script><!-- </script>"}) {
    EXPECT_NE(XmlCheck::problem_in(text), "") << text;
  }
}

TEST(Svg, CarriesDataForAScriptOnAPageOnly) {
  Svg svg(10, 10);
  svg.set_data("plot", "1 2 \"3\"");
  const std::vector<std::vector<Px>> ring = {{{0, 0}, {9, 0}, {9, 9}}};
  svg.polygon(ring, {.fill = kWhite, .zone = 7});
  EXPECT_EQ(XmlCheck::problem_in(svg.inline_text()), "");
  EXPECT_EQ(count_of(svg.inline_text(), " data-plot=\"1 2 &quot;3&quot;\""), 1u);
  EXPECT_EQ(count_of(svg.inline_text(), " data-zone=\"7\""), 1u);
  EXPECT_EQ(count_of(svg.file_text(), "data-plot"), 0u);
}

TEST(Svg, KnowsItsColoursButThoseOnBlocks) {
  Svg inner(5, 5), svg(10, 10);
  inner.line({0, 0}, {1, 1}, {.stroke = kDoor});
  svg.place(inner, {0, 0});
  svg.rect({0, 0}, 1, 1, {.fill = kOurs});
  svg.text({1, 1}, "x", {.color = kInk, .halo = kWhite});
  svg.text({1, 1}, "y", {.color = kLimit, .on_color = true});
  EXPECT_EQ(svg.colors(), (std::set<Color>{kDoor, kOurs, kInk, kWhite}));
}

TEST(Svg, IsWellFormed) {
  EXPECT_EQ(XmlCheck::problem_in(everything().file_text()), "");
  EXPECT_EQ(XmlCheck::problem_in(everything().inline_text()), "");
}

TEST(Svg, EscapesTextAndHints) {
  const std::string text = everything().inline_text();
  EXPECT_EQ(count_of(text, ">R&amp;D &lt;1&gt;</text>"), 1u);
  EXPECT_EQ(count_of(text, "<title>L1 &amp; &quot;L2&quot;</title>"), 1u);
  EXPECT_EQ(count_of(text, "<title>a &lt;group&gt;</title>"), 1u);
}

TEST(Svg, TheSameCallsGiveTheSameBytes) {
  EXPECT_EQ(everything().file_text(), everything().file_text());
}

TEST(Svg, HolesAreCutOutByTheEvenOddRule) {
  EXPECT_EQ(count_of(everything().inline_text(),
                     "fill-rule=\"evenodd\" d=\"M0,0L9,0L9,9ZM1,1L2,1L2,2Z\""),
            1u);
}

TEST(Svg, LeavesOutPointsThatAreNotFinite) {
  Svg svg(10, 10);
  svg.line({kSvgNaN, 0}, {1, 1}, {.stroke = kInk});
  svg.circle({0, kSvgNaN}, 1, {.fill = kInk});
  svg.circle({0, 0}, kSvgNaN, {.fill = kInk});
  svg.rect({0, 0}, kSvgNaN, 1, {.fill = kInk});
  svg.text({kSvgNaN, 0}, "x", {});
  EXPECT_EQ(svg.inline_text(), Svg(10, 10).inline_text());
  const std::vector<Px> points = {{0, 0}, {kSvgNaN, 1}, {2, 2}};
  svg.polyline(points, {.stroke = kInk});
  EXPECT_EQ(count_of(svg.inline_text(), "points=\"0,0 2,2\""), 1u);
}

TEST(Svg, KeepsHugeCoordinatesReadableByEveryViewer) {
  Svg svg(10, 10);
  svg.line({-1e300, 0}, {1e300, 1}, {.stroke = kInk});
  EXPECT_EQ(count_of(svg.inline_text(), "x1=\"-1000000\" y1=\"0\" x2=\"1000000\""), 1u);
}

TEST(Svg, PlacesOneDrawingInAnother) {
  Svg sheet(300, 300);
  sheet.place(everything(), {20, 30});
  const std::string text = sheet.file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  EXPECT_EQ(count_of(text, "<svg x=\"20\" y=\"30\" width=\"200\" height=\"100\">"), 1u);
}

}  // namespace
}  // namespace zonepack::report
