// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/report/svg.hpp"
#include "runtime/report/ticks.hpp"

// Values over the time of a run, from zero up, with their context: a limit, the zone the robot was
// in, spans of time in which something went wrong. Times are seconds since the start of the run;
// with another `axis`, what that says.
namespace zonepack::report {

struct Sample {
  double t_s = 0;
  double value = 0;
};

struct ChartSeries {
  std::string name;
  std::vector<Sample> samples;  // by time; samples that are not finite break the line
  Color color = kOurs;
  bool steps = true;      // the value holds until the next sample
  bool compared = false;  // thinner, below the others
};

struct ChartLimit {
  std::string name;
  double value = 0;
};

struct TimeSpan {
  double from_s = 0;
  double to_s = 0;
};

struct ChartShade {
  std::string name;
  Color color = kLimit;
  std::vector<TimeSpan> spans;
};

struct TimelineBlock {
  TimeSpan span;
  std::string name;
  Color color;
};

struct Chart {
  std::string title;
  std::vector<ChartSeries> series;
  std::optional<ChartLimit> limit;
  std::vector<ChartShade> shades;       // the first lies on top
  std::vector<TimelineBlock> timeline;  // the zone the robot was in
  Quantity quantity = Quantity::kNumber;
  std::string unit;       // after numbers (" m"); empty for counts and bytes
  double duration_s = 0;  // end of the time axis, unless the last sample is later
  std::string axis = "seconds since the start";
  Quantity axis_quantity = Quantity::kNumber;
  double width_px = 900;
  double plot_height_px = 190;
};

Svg draw_chart(const Chart& chart);

// The same chart for a page as narrow as a phone's.
inline constexpr double kNarrowWidth_px = 340;
Chart narrowed(Chart chart);

// What the page's script needs to name values at a moment: every series as whole numbers, each but
// the first as its difference from the one before; times in ms. Of a long series no more than
// kMostSeriesPoints: steps keep their peaks, lines their corners.
inline constexpr std::size_t kMostSeriesPoints = 20'000;
std::string chart_json(const Chart& chart);

// The value at the end of each series, as printed next to it.
std::string end_value(const Chart& chart, double value);

}  // namespace zonepack::report
