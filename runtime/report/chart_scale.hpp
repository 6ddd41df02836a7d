// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "runtime/report/chart.hpp"

namespace zonepack::report {

// Maps times and values of a chart to the page.
struct ChartScale {
  double left = 0, top = 0, width = 0, height = 0;  // the plot, pixels
  double duration_s = 1;
  double most = 1;  // value at the top

  double x(double t_s) const noexcept { return left + t_s / duration_s * width; }
  double y(double value) const noexcept { return top + height - value / most * height; }
  double bottom() const noexcept { return top + height; }
  double right() const noexcept { return left + width; }
};

// Finite extent of the data: all series, the limit, the timeline.
double last_time_s(const Chart& chart) noexcept;
double largest_value(const Chart& chart) noexcept;

// The lines of a series on the page: one per stretch without a gap. Steps get a corner per change.
// The values of one pixel column are reduced to the first, least, greatest and last, so that a
// day's log stays small and no peak is lost.
std::vector<std::vector<Px>> series_lines(const ChartSeries& series, const ChartScale& scale);

// Moves labels of this height apart, as little as possible, within [top, bottom]; keeps their
// order. `centers` need not be sorted.
void spread_labels(std::span<double> centers, double height, double top, double bottom);

}  // namespace zonepack::report
