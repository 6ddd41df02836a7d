// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/chart.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "runtime/report/chart_scale.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ChartScale unit_scale() {
  ChartScale scale;  // a second is 10 px, a value 1 px, zero at y = 100
  scale.width = 100;
  scale.height = 100;
  scale.duration_s = 10;
  scale.most = 100;
  return scale;
}

ChartSeries series(std::vector<Sample> samples, bool steps = true) {
  return {.name = "s", .samples = std::move(samples), .color = kOurs, .steps = steps};
}

void expect_points(const std::vector<Px>& points, const std::vector<Px>& expected) {
  ASSERT_EQ(points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_DOUBLE_EQ(points[i].x, expected[i].x) << i;
    EXPECT_DOUBLE_EQ(points[i].y, expected[i].y) << i;
  }
}

TEST(ChartScale, StepsHoldTheirValueUntilTheNext) {
  const auto lines = series_lines(series({{0, 0}, {4, 30}, {8, 30}, {10, 50}}), unit_scale());
  ASSERT_EQ(lines.size(), 1u);
  expect_points(lines[0], {{0, 100}, {40, 100}, {40, 70}, {100, 70}, {100, 50}});
}

TEST(ChartScale, ThinsEqualStepsToTheirEnds) {
  std::vector<Sample> samples;
  for (int i = 0; i <= 1000; ++i) samples.push_back({i / 100.0, 7});
  expect_points(series_lines(series(samples), unit_scale())[0], {{0, 93}, {100, 93}});
}

TEST(ChartScale, ThinningKeepsPeaksAndDips) {
  std::vector<Sample> samples;
  for (int i = 0; i <= 100000; ++i) {
    samples.push_back({i / 10000.0, i == 54321 ? 99.0 : i == 54322 ? 1.0 : 50.0});
  }
  const auto lines = series_lines(series(samples, false), unit_scale());
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_LE(lines[0].size(), 4u * 101);
  double highest = 100, lowest = 0;
  for (const Px& p : lines[0]) {
    highest = std::min(highest, p.y);
    lowest = std::max(lowest, p.y);
  }
  EXPECT_DOUBLE_EQ(highest, 1);
  EXPECT_DOUBLE_EQ(lowest, 99);
}

TEST(ChartScale, AGapBreaksTheLine) {
  const auto lines =
      series_lines(series({{kNaN, 1}, {0, 1}, {1, 2}, {2, kNaN}, {3, 4}}, false), unit_scale());
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].size(), 2u);
  EXPECT_EQ(lines[1].size(), 1u);
}

TEST(ChartScale, CoversSeriesLimitAndDuration) {
  Chart chart;
  chart.duration_s = 5;
  chart.series = {series({{0, 3}, {7, 8}, {kNaN, 1e9}, {1, kNaN}})};
  EXPECT_DOUBLE_EQ(last_time_s(chart), 7);
  EXPECT_DOUBLE_EQ(largest_value(chart), 8);
  chart.limit = ChartLimit{"limit", 100};
  EXPECT_DOUBLE_EQ(largest_value(chart), 100);
  EXPECT_DOUBLE_EQ(last_time_s(Chart{}), 1);
}

TEST(ChartScale, LabelsAreSpreadInOrderAndInsideTheirRoom) {
  std::vector<double> centers = {50, 49, 98, 51};
  spread_labels(centers, 10, 0, 100);
  EXPECT_LE(centers[1] + 10, centers[0]);
  EXPECT_LE(centers[0] + 10, centers[3]);
  EXPECT_LE(centers[3] + 10, centers[2]);
  EXPECT_LE(centers[2], 95);
  EXPECT_GE(centers[1], 5);
}

Chart memory_chart() {
  Chart chart;
  chart.title = "Signatures & bytes";
  chart.series = {series({{0, 0}, {1, 31}, {60, 82}})};
  chart.series.push_back({"RTAB-Map", {{0, 184}, {60, 95}}, kOther, true, true});
  chart.limit = ChartLimit{"limit: 100 signatures", 100};
  chart.shades = {{"zone absent", kLimit, {{0, 1}}}, {"blocked", kDoor, {}}};
  chart.timeline = {{{0, 30}, "L1", hue(0)}, {{30, 60}, "H1", hue(1)}};
  chart.duration_s = 60;
  return chart;
}

TEST(Chart, ShowsSeriesLimitShadesAndTimeline) {
  const std::string text = draw_chart(memory_chart()).file_text();
  EXPECT_EQ(XmlCheck::problem_in(text), "");
  EXPECT_EQ(count_of(text, ">Signatures &amp; bytes</text>"), 1u);
  EXPECT_EQ(count_of(text, ">limit: 100 signatures</text>"), 1u);
  EXPECT_EQ(count_of(text, "stroke-dasharray=\"6 4\""), 1u);
  EXPECT_EQ(count_of(text, ">L1</text>"), 1u);
  EXPECT_EQ(count_of(text, "<title>H1: 30 to 60 s</title>"), 1u);
  EXPECT_EQ(count_of(text, ">82</text>"), 1u);
  EXPECT_EQ(count_of(text, ">95</text>"), 1u);
}

TEST(Chart, NamesAShadeOnlyWhenItOccurs) {
  const std::string text = draw_chart(memory_chart()).inline_text();
  EXPECT_EQ(count_of(text, ">zone absent</text>"), 1u);
  EXPECT_EQ(count_of(text, ">blocked</text>"), 0u);
}

TEST(Chart, TheFirstShadeLiesOnTop) {
  Chart chart = memory_chart();
  chart.shades = {{"absent", kLimit, {{1, 2}}}, {"blocked", kDoor, {{0, 3}}}};
  const std::string text = draw_chart(chart).inline_text();
  EXPECT_LT(text.find("<title>blocked</title>"), text.find("<title>absent</title>"));
}

TEST(Chart, TheSameDataGivesTheSameBytes) {
  EXPECT_EQ(draw_chart(memory_chart()).file_text(), draw_chart(memory_chart()).file_text());
}

TEST(Chart, SurvivesNoDataNoSpreadAndHugeValues) {
  EXPECT_EQ(XmlCheck::problem_in(draw_chart(Chart{}).inline_text()), "");
  for (const double value : {0.0, 1e-12, 1e300, kNaN, std::numeric_limits<double>::infinity()}) {
    Chart chart = memory_chart();
    chart.series = {series({{0, value}, {1, value}, {2, 1}}), series({{0, kNaN}})};
    for (const Quantity quantity : {Quantity::kNumber, Quantity::kBytes}) {
      chart.quantity = quantity;
      const std::string text = draw_chart(chart).inline_text();
      EXPECT_EQ(XmlCheck::problem_in(text), "") << value;
      EXPECT_EQ(text.find("nan"), std::string::npos) << value;
      EXPECT_EQ(text.find("inf"), std::string::npos) << value;
    }
  }
}

TEST(Chart, PrintsEndValuesInTheirUnit) {
  Chart chart;
  EXPECT_EQ(end_value(chart, 82), "82");
  chart.unit = " m";
  EXPECT_EQ(end_value(chart, 0.0371), "0.04 m");
  chart.quantity = Quantity::kBytes;
  EXPECT_EQ(end_value(chart, 2097152), "2 MiB");
}

}  // namespace
}  // namespace zonepack::report
