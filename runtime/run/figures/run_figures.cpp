// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/run_figures.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "runtime/report/format.hpp"
#include "runtime/report/thinning.hpp"

namespace zonepack {
namespace {

using report::Chart;
using report::ChartSeries;
using report::Color;
using report::Sample;

constexpr Color kNotVisited{0xf6, 0xf7, 0xf8};
constexpr double kZoneTint = 0.2;

template <typename Fn>
std::vector<Sample> samples_of(const RunTrace& trace, Fn&& value) {
  std::vector<Sample> samples;
  samples.reserve(trace.samples.size() + 1);
  for (const TraceSample& s : trace.samples) {
    samples.push_back({s.t_s, static_cast<double>(value(s))});
  }
  if (!samples.empty() && samples.back().t_s < trace.duration_s) {
    samples.push_back({trace.duration_s, samples.back().value});
  }
  return samples;
}

std::vector<Sample> samples_of(const std::vector<BaselineRow>& rows, double BaselineRow::*value) {
  std::vector<Sample> samples;
  samples.reserve(rows.size());
  for (const BaselineRow& row : rows) samples.push_back({row.t_s, row.*value});
  return samples;
}

ChartSeries compared(std::string name, std::vector<Sample> samples, Color color) {
  return {.name = std::move(name), .samples = std::move(samples), .color = color, .compared = true};
}

// Next to another's curves, ours need a name too.
std::string ours(const char* what, const std::vector<BaselineRow>& baseline) {
  return std::string(baseline.empty() ? "" : "Zonepack ") + what;
}

Chart chart_of(const RunTrace& trace) {
  Chart chart;
  chart.duration_s = trace.duration_s;
  chart.timeline = zone_timeline(trace, zone_colors(trace));
  chart.shades = {
      {"own zone not in memory", report::kLimit, spans_where(trace, &TraceSample::zone_absent)},
      {"waiting for room", report::kDoor, spans_where(trace, &TraceSample::blocked)}};
  return chart;
}

// Zones in the order of the first visit, then the others.
std::vector<ZoneId> by_first_visit(const RunTrace& trace) {
  std::vector<ZoneId> order;
  std::vector<bool> seen(trace.zones.size(), false);
  const auto add = [&](ZoneId zone) {
    if (zone >= seen.size() || seen[zone]) return;
    seen[zone] = true;
    order.push_back(zone);
  };
  for (const TraceSample& s : trace.samples) add(s.tracked_zone);
  for (ZoneId zone = 0; zone < trace.zones.size(); ++zone) add(zone);
  return order;
}

// Indices of the samples that draw a route: of a long run the corners, by 1 cm or more, and where
// the zone changes, so that the drawing's size has a bound.
template <typename Place>
std::vector<std::size_t> route_samples(const RunTrace& trace, Place&& place) {
  constexpr std::size_t kMostPoints = 4'000;
  constexpr std::array<double, 3> kTolerance = {0.01, 0.01, 0.4};  // m, m, a zone's number
  std::vector<std::size_t> samples;
  std::vector<report::Waypoint> points;
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    const TraceSample& s = trace.samples[i];
    const std::optional<Point2> p = place(s);
    if (!p) continue;
    samples.push_back(i);
    const bool in_zone = s.tracked_zone < trace.zones.size();
    points.push_back({s.t_s, {p->x_m, p->y_m, in_zone ? static_cast<double>(s.tracked_zone) : -1}});
  }
  if (samples.size() <= kMostPoints) return samples;
  std::vector<std::size_t> kept;
  for (const std::size_t i : report::corners_of(points, kTolerance, kMostPoints)) {
    kept.push_back(samples[i]);
  }
  return kept;
}

std::optional<Point2> estimated(const TraceSample& s) {
  if (!s.pose_valid) return std::nullopt;
  return Point2{s.estimate.x_m, s.estimate.y_m};
}

std::optional<Point2> true_place(const TraceSample& s) {
  if (!s.has_truth) return std::nullopt;
  return Point2{s.truth.x_m, s.truth.y_m};
}

}  // namespace

std::vector<Color> zone_colors(const RunTrace& trace) {
  constexpr std::size_t kNone = report::kHueCount;
  std::vector<std::size_t> hue_of(trace.zones.size(), kNone);
  std::vector<std::vector<ZoneId>> neighbours(trace.zones.size());
  for (const TracePortal& portal : trace.portals) {
    if (portal.zone_a >= trace.zones.size() || portal.zone_b >= trace.zones.size()) continue;
    neighbours[portal.zone_a].push_back(portal.zone_b);
    neighbours[portal.zone_b].push_back(portal.zone_a);
  }
  std::array<std::size_t, report::kHueCount> used{};
  for (const ZoneId zone : by_first_visit(trace)) {
    std::array<std::size_t, report::kHueCount> cost = used;
    for (const ZoneId other : neighbours[zone]) {
      if (hue_of[other] != kNone) cost[hue_of[other]] += trace.zones.size();
    }
    const auto best = std::ranges::min_element(cost);
    hue_of[zone] = static_cast<std::size_t>(best - cost.begin());
    ++used[hue_of[zone]];
  }
  std::vector<Color> colors;
  colors.reserve(hue_of.size());
  for (const std::size_t index : hue_of) colors.push_back(report::hue(index));
  return colors;
}

std::vector<report::TimelineBlock> zone_timeline(const RunTrace& trace,
                                                 const std::vector<Color>& colors) {
  std::vector<report::TimelineBlock> blocks;
  ZoneId zone = kNoZone;
  for (const TraceSample& s : trace.samples) {
    if (s.tracked_zone == zone) continue;
    if (zone != kNoZone) blocks.back().span.to_s = s.t_s;
    zone = s.tracked_zone < trace.zones.size() ? s.tracked_zone : kNoZone;
    if (zone == kNoZone) continue;
    blocks.push_back({{s.t_s, trace.duration_s}, trace.zones[zone].name, colors[zone]});
  }
  return blocks;
}

std::vector<report::TimeSpan> spans_where(const RunTrace& trace, bool TraceSample::*flag) {
  std::vector<report::TimeSpan> spans;
  bool open = false;
  for (const TraceSample& s : trace.samples) {
    if (s.*flag && !open) spans.push_back({s.t_s, trace.duration_s});
    if (!(s.*flag) && open) spans.back().to_s = s.t_s;
    open = s.*flag;
  }
  return spans;
}

report::FloorPlan route_plan(const RunTrace& trace, const std::vector<Color>& colors) {
  report::FloorPlan plan;
  std::vector<bool> visited(trace.zones.size(), false);
  for (const TraceSample& s : trace.samples) {
    if (s.tracked_zone < visited.size()) visited[s.tracked_zone] = true;
  }
  for (const std::size_t i : route_samples(trace, estimated)) {
    const TraceSample& s = trace.samples[i];
    const Color color = s.tracked_zone < colors.size() ? colors[s.tracked_zone] : report::kQuiet;
    plan.route.push_back({*estimated(s), color});
  }
  for (const std::size_t i : route_samples(trace, true_place)) {
    plan.true_route.push_back(*true_place(trace.samples[i]));
  }
  for (std::size_t i = 0; i < trace.zones.size(); ++i) {
    const TraceZone& zone = trace.zones[i];
    plan.zones.push_back(
        {.name = zone.name,
         .note = {},
         .hint = zone.name + " (" + zone.zone_type + "): " + std::to_string(zone.signatures) +
                 " signatures, " + report::format_bytes(static_cast<double>(zone.charged_bytes)),
         .polygon = zone.polygon,
         .fill = visited[i] ? report::mix(report::kWhite, colors[i], kZoneTint) : kNotVisited});
  }
  for (const TracePortal& portal : trace.portals) plan.portals.push_back(portal.segment);
  return plan;
}

Chart loading_chart(const RunTrace& trace, const std::vector<BaselineRow>& baseline) {
  Chart chart = chart_of(trace);
  chart.series = {
      {.name = ours("loaded", baseline),
       .samples = samples_of(trace, [](const TraceSample& s) { return s.signatures_loaded; })},
      {.name = ours("unloaded", baseline),
       .samples = samples_of(trace, [](const TraceSample& s) { return s.signatures_unloaded; }),
       .color = report::kOursToo}};
  if (!baseline.empty()) {
    chart.series.push_back(
        compared("RTAB-Map loaded", samples_of(baseline, &BaselineRow::loaded), report::kOther));
    chart.series.push_back(compared(
        "RTAB-Map unloaded", samples_of(baseline, &BaselineRow::unloaded), report::kOtherToo));
  }
  return chart;
}

Chart signatures_chart(const RunTrace& trace, const std::vector<BaselineRow>& baseline) {
  Chart chart = chart_of(trace);
  chart.series = {
      {.name = ours("in memory", baseline),
       .samples = samples_of(trace, [](const TraceSample& s) { return s.charged_signatures; })}};
  if (!baseline.empty()) {
    chart.series.push_back(compared("RTAB-Map in working memory",
                                    samples_of(baseline, &BaselineRow::in_memory), report::kOther));
  }
  if (trace.max_signatures > 0) {
    chart.limit =
        report::ChartLimit{"limit: " + std::to_string(trace.max_signatures) + " signatures",
                           static_cast<double>(trace.max_signatures)};
  }
  return chart;
}

Chart bytes_chart(const RunTrace& trace) {
  Chart chart = chart_of(trace);
  chart.quantity = report::Quantity::kBytes;
  chart.series = {
      {.name = "charged",
       .samples = samples_of(trace, [](const TraceSample& s) { return s.charged_bytes; })},
      compared("of it tables and buffers",
               samples_of(trace, [&](const TraceSample&) { return trace.fixed_bytes; }),
               report::kOther)};
  if (trace.budget_bytes > 0) {
    chart.limit =
        report::ChartLimit{"budget: " + report::format_count(trace.budget_bytes) + " bytes",
                           static_cast<double>(trace.budget_bytes)};
  }
  return chart;
}

Chart pose_error_chart(const RunTrace& trace) {
  Chart chart = chart_of(trace);
  chart.shades.clear();
  chart.unit = " m";
  chart.plot_height_px = 130;
  ChartSeries error{.name = "distance to the true position", .samples = {}, .steps = false};
  for (const TraceSample& s : trace.samples) {
    const bool known = s.has_truth && s.pose_valid;
    error.samples.push_back({s.t_s, known ? distance_m(Point2{s.estimate.x_m, s.estimate.y_m},
                                                       Point2{s.truth.x_m, s.truth.y_m})
                                          : std::numeric_limits<double>::quiet_NaN()});
  }
  chart.series = {std::move(error)};
  return chart;
}

}  // namespace zonepack
