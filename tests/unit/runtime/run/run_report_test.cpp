// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run_report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "runtime/run/figures/run_figures.hpp"
#include "runtime/run/run_statistics.hpp"
#include "tests/support/xml_check.hpp"

namespace zonepack {
namespace {

using report::to_html;

Polygon box(double x0, double x1) { return {{{x0, 0}, {x1, 0}, {x1, 5}, {x0, 5}}, {}}; }

// Three rooms in a row, driven through from left to right in 30 s; the last one comes late.
RunTrace three_rooms() {
  RunTrace trace;
  trace.zones = {{"A", "room", box(0, 10), 10, 1000},
                 {"B<1>", "corridor", box(10, 20), 20, 2000},
                 {"C", "room", box(20, 30), 30, 3000}};
  trace.portals = {{{{10, 2}, {10, 3}}, 0, 1}, {{{20, 2}, {20, 3}}, 1, 2}};
  trace.budget_bytes = 5500;
  trace.fixed_bytes = 400;
  trace.max_signatures = 50;
  trace.duration_s = 30;
  for (int i = 0; i < 30; ++i) {
    TraceSample s;
    s.t_s = i;
    s.pose_valid = i > 0;
    s.estimate = {i + 0.3, 2.5, 0};
    s.has_truth = true;
    s.truth = {static_cast<double>(i), 2.1, 0};  // 0.5 m off: 0.3, 0.4
    s.tracked_zone = static_cast<ZoneId>(i / 10);
    s.zone_absent = i >= 20 && i < 22;
    s.charged_signatures = i < 10 ? 10 : i < 20 ? 30 : 50;
    s.charged_bytes = 400 + 100 * s.charged_signatures;
    s.signatures_loaded = i < 10 ? 10 : i < 20 ? 30 : 60;
    s.signatures_unloaded = i < 20 ? 0 : 10;
    trace.samples.push_back(s);
  }
  return trace;
}

RunSummary summary() {
  RunSummary s;
  s.budget_bytes = 5500;
  s.peak_charged_bytes = 5400;
  s.max_signatures = 50;
  s.peak_signatures = 50;
  s.signatures_loaded = 60;
  s.signatures_unloaded = 10;
  s.cycles = 1500;
  s.zone_absent_s = 2;
  s.pose_error_m = PoseError{.p50 = 0.5, .p95 = 0.5, .max = 0.5};
  s.event_log_hash = "c0ffee";
  return s;
}

const std::vector<BaselineRow> kNoBaseline;

TEST(RunFigures, NeighboursNeverShareAColour) {
  RunTrace trace;
  for (int i = 0; i < 40; ++i) trace.zones.push_back({std::to_string(i), "", box(i, i + 1), 1, 1});
  // A lobby with 39 rooms: any order of nine colours would give some room the lobby's.
  for (ZoneId room = 1; room < 40; ++room) trace.portals.push_back({{}, 0, room});
  trace.portals.push_back({{}, 3, kNoZone});  // a portal to nowhere is no neighbour
  const auto colors = zone_colors(trace);
  ASSERT_EQ(colors.size(), 40u);
  for (ZoneId room = 1; room < 40; ++room) EXPECT_NE(colors[room], colors[0]) << room;
}

TEST(RunFigures, TheTimelineHasOneBlockForEachStay) {
  RunTrace trace = three_rooms();
  trace.samples[0].tracked_zone = kNoZone;
  trace.samples[15].tracked_zone = kNoZone;
  trace.samples[29].tracked_zone = 0;
  const auto blocks = zone_timeline(trace, zone_colors(trace));
  ASSERT_EQ(blocks.size(), 5u);
  const std::tuple<std::string, double, double> expected[] = {
      {"A", 1, 10}, {"B<1>", 10, 15}, {"B<1>", 16, 20}, {"C", 20, 29}, {"A", 29, 30}};
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_EQ(std::tuple(blocks[i].name, blocks[i].span.from_s, blocks[i].span.to_s), expected[i]);
  }
}

TEST(RunFigures, FlagsBecomeStretchesOfTime) {
  RunTrace trace = three_rooms();
  trace.samples[29].zone_absent = true;
  const auto spans = spans_where(trace, &TraceSample::zone_absent);
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_DOUBLE_EQ(spans[0].from_s, 20);
  EXPECT_DOUBLE_EQ(spans[0].to_s, 22);
  EXPECT_DOUBLE_EQ(spans[1].to_s, 30);  // still so at the end
  EXPECT_TRUE(spans_where(trace, &TraceSample::blocked).empty());
}

TEST(RunFigures, TheRouteIsOnlyWhereAPoseWasKnown) {
  const RunTrace trace = three_rooms();
  const report::FloorPlan plan = route_plan(trace, zone_colors(trace));
  EXPECT_EQ(plan.route.size(), 29u);
  EXPECT_EQ(plan.true_route.size(), 30u);
  EXPECT_EQ(plan.portals.size(), 2u);
}

TEST(RunFigures, TheErrorIsTheDistanceToTheTruth) {
  const report::Chart chart = pose_error_chart(three_rooms());
  ASSERT_EQ(chart.series.size(), 1u);
  EXPECT_TRUE(std::isnan(chart.series[0].samples[0].value));
  EXPECT_NEAR(chart.series[0].samples[1].value, 0.5, 1e-12);
}

TEST(RunFigures, CurvesGoOnToTheEndOfTheRun) {
  const report::Chart chart = loading_chart(three_rooms(), kNoBaseline);
  EXPECT_DOUBLE_EQ(chart.series[0].samples.back().t_s, 30);
  EXPECT_DOUBLE_EQ(chart.series[0].samples.back().value, 60);
}

TEST(RunReport, ShowsLimitsPeaksAndTheHash) {
  const RunSummary s = summary();
  const RunTrace trace = three_rooms();
  const std::string html = to_html(make_run_report({"map", "can0.log", s, trace, kNoBaseline}));
  EXPECT_EQ(XmlCheck::problem_in(html), "");
  for (const char* part : {"60 signatures loaded, 10 unloaded.", "(98.2 %)", "missing for 2 s",
                           "limit: 50 signatures", "c0ffee", "B&lt;1&gt;"}) {
    EXPECT_GE(count_of(html, part), 1u) << part;
  }
  EXPECT_EQ(count_of(html, "RTAB-Map"), 0u);
  EXPECT_EQ(count_of(html, "<figure>"), 5u);
}

TEST(RunReport, PutsTheBaselineBesideOurs) {
  const RunSummary s = summary();
  const RunTrace trace = three_rooms();
  const std::vector<BaselineRow> rows = {{0, 184, 0, 1}, {30, 95, 981, 1071}};
  const std::string html = to_html(make_run_report({"map", "can0.log", s, trace, rows}));
  EXPECT_GE(count_of(html, ">RTAB-Map loaded</text>"), 1u);
  EXPECT_EQ(count_of(html, ">Zonepack loaded</text>"), 2u);  // wide and narrow
  EXPECT_EQ(count_of(html, ">981, 1071<"), 1u);
  EXPECT_EQ(count_of(html, ">1071</text>"), 2u);
}

TEST(RunReport, SaysLoudlyThatALimitWasExceeded) {
  RunSummary s = summary();
  s.budget_violations = 1;
  const report::Report page = make_run_report({"map", "can0.log", s, three_rooms(), kNoBaseline});
  EXPECT_NE(page.headline.find("exceeded in 1 cycle."), std::string::npos);
  EXPECT_TRUE(page.facts[2].bad);
}

TEST(RunReport, WithoutTruthThereIsNoErrorFigure) {
  RunTrace trace = three_rooms();
  for (TraceSample& s : trace.samples) s.has_truth = false;
  RunSummary s = summary();
  s.pose_error_m.reset();
  s.wrong_zone_s.reset();
  const report::Report page = make_run_report({"map", "can0.log", s, trace, kNoBaseline});
  EXPECT_EQ(page.figures.size(), 4u);
  EXPECT_EQ(to_html(page).find("pose error"), std::string::npos);
  EXPECT_EQ(to_html(page).find(" s in a wrong zone"), std::string::npos);
  EXPECT_NE(to_html(page).find("no truth, so nothing is known of wrong zones"), std::string::npos);
}

TEST(RunReport, OfARunWithoutSamplesIsStillAPage) {
  const report::Report page =
      make_run_report({"map", "can0.log", RunSummary{}, RunTrace{}, kNoBaseline});
  EXPECT_EQ(XmlCheck::problem_in(to_html(page)), "");
  EXPECT_EQ(to_html(page).find("nan"), std::string::npos);
}

TEST(RunReport, IsPlayedWithPosesStaysHoldsAndEvents) {
  RunTrace trace = three_rooms();
  trace.samples[5].tracked_zone = kNoZone;
  trace.holds = {{0, 0, 1, 20}, {2, 18, 22, 30}};
  trace.events = {{18, "load_started", 2}, {22.5, "correction_rejected", kNoZone}};
  const report::Report page = make_run_report({"map", "can0.log", summary(), trace, kNoBaseline});
  ASSERT_TRUE(page.playback);
  // The first pose is unknown. From t = 1 s on the robot moves 1 m a second along y = 2.5, so two
  // ends say it all: 1.3 m to 29.3 m.
  const std::string json = report::playback_json(*page.playback);
  for (const char* part :
       {"{\"duration\":30000,", "\"t\":[0,1000,28000],\"x\":[null,1300,28000],\"y\":[null,2500,0]",
        "\"holds\":[0,0,1000,20000,2,18000,4000,12000]",
        // A from 0 to 5 s and from 6 to 10 s, B to 20 s, C to the end.
        "\"stays\":[0,0,5000,0,6000,4000,1,10000,10000,2,20000,10000]",
        "\"kinds\":[\"load_started\",\"correction_rejected\"],\"t\":[18000,4500],\"k\":[0,1],"
        "\"z\":[2,-1]"}) {
    EXPECT_EQ(count_of(json, part), 1u) << part << " in " << json;
  }
}

// The longest trace that is kept, in which everything changes all the time: a size that mail takes.
TEST(RunReport, OfTheWorstRunHasABoundedSize) {
  RunTrace trace = three_rooms();
  trace.samples.clear();
  for (int i = 0; i < static_cast<int>(RunStatistics::kMostSamples); ++i) {
    TraceSample s;
    s.t_s = i * 1.5;
    s.pose_valid = true;
    s.estimate = {15 + 14 * std::sin(i * 0.7), 2.5 + 2 * std::cos(i * 1.3), i * 2.0};
    s.has_truth = true;
    s.truth = {s.estimate.x_m + 0.1 * std::sin(i * 3.0), s.estimate.y_m, 0};
    s.tracked_zone = static_cast<ZoneId>(i % 3);
    s.zone_absent = i % 5 == 0;
    s.blocked = i % 7 == 0;
    s.charged_bytes = static_cast<ByteCount>(400 + i * 7919 % 5000);
    s.charged_signatures = static_cast<std::uint64_t>(i % 50);
    s.signatures_loaded = static_cast<std::uint64_t>(i * 10);
    s.signatures_unloaded = static_cast<std::uint64_t>(i * 10 - i % 50);
    trace.samples.push_back(s);
  }
  trace.duration_s = trace.samples.back().t_s;
  for (int i = 0; i < static_cast<int>(HoldKeeper::kMost); ++i) {
    trace.holds.push_back({static_cast<ZoneId>(i % 3), i * 4.5, i * 4.5 + 1, i * 4.5 + 3});
    trace.events.push_back({i * 4.5, "load_started", static_cast<ZoneId>(i % 3)});
  }
  const std::string html =
      to_html(make_run_report({"map", "can0.log", summary(), trace, kNoBaseline}));
  RecordProperty("bytes", std::to_string(html.size()));
  EXPECT_LT(html.size(), 5u * 1000 * 1000);
}

TEST(RunReport, ThePictureHoldsTheRouteAndTheCurves) {
  const RunSummary s = summary();
  const RunTrace trace = three_rooms();
  const report::Report page = make_run_picture({"map", "can0.log", s, trace, kNoBaseline});
  const std::string svg = report::to_sheet(page).file_text();
  EXPECT_EQ(XmlCheck::problem_in(svg), "");
  EXPECT_EQ(page.figures.size(), 3u);
  EXPECT_EQ(count_of(svg, ">portal</text>"), 1u);
  EXPECT_EQ(count_of(svg, ">unloaded</text>"), 1u);
}

TEST(RunReport, TheSameRunGivesTheSameBytes) {
  const RunSummary s = summary();
  const RunTrace trace = three_rooms();
  EXPECT_EQ(to_html(make_run_report({"map", "can0.log", s, trace, kNoBaseline})),
            to_html(make_run_report({"map", "can0.log", s, trace, kNoBaseline})));
}

}  // namespace
}  // namespace zonepack
