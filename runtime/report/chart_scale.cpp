// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/chart_scale.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace zonepack::report {
namespace {

bool is_finite(const Sample& sample) noexcept {
  return std::isfinite(sample.t_s) && std::isfinite(sample.value);
}

// Appends the points of one pixel column: all of them, or only the first, least, greatest and last
// when there are many.
void flush_column(std::span<const Px> column, std::vector<Px>& out) {
  if (column.size() <= 4) {
    out.insert(out.end(), column.begin(), column.end());
    return;
  }
  const auto [low, high] = std::ranges::minmax_element(column, {}, &Px::y);
  out.insert(out.end(),
             {column.front(), low < high ? *low : *high, low < high ? *high : *low, column.back()});
}

std::vector<Px> thinned(std::span<const Px> points) {
  std::vector<Px> out;
  std::size_t from = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    if (i < points.size() && std::floor(points[i].x) == std::floor(points[from].x)) continue;
    flush_column(points.subspan(from, i - from), out);
    from = i;
  }
  return out;
}

std::vector<Px> steps_of(std::span<const Sample> samples, const ChartScale& scale) {
  std::vector<Px> points;
  const auto add = [&points](Px p) {
    // A run of equal values needs only its two ends.
    const std::size_t n = points.size();
    if (n >= 2 && points[n - 1].y == p.y && points[n - 2].y == p.y) points.pop_back();
    points.push_back(p);
  };
  for (const Sample& sample : samples) {
    const Px p{scale.x(sample.t_s), scale.y(sample.value)};
    if (!points.empty() && points.back().y != p.y) add({p.x, points.back().y});
    add(p);
  }
  return points;
}

}  // namespace

double last_time_s(const Chart& chart) noexcept {
  double last = std::isfinite(chart.duration_s) ? std::max(chart.duration_s, 0.0) : 0.0;
  for (const ChartSeries& series : chart.series) {
    for (const Sample& sample : series.samples) {
      if (is_finite(sample)) last = std::max(last, sample.t_s);
    }
  }
  return last > 0 ? last : 1;
}

double largest_value(const Chart& chart) noexcept {
  double most = chart.limit && std::isfinite(chart.limit->value) ? chart.limit->value : 0;
  for (const ChartSeries& series : chart.series) {
    for (const Sample& sample : series.samples) {
      if (is_finite(sample)) most = std::max(most, sample.value);
    }
  }
  return most;
}

std::vector<std::vector<Px>> series_lines(const ChartSeries& series, const ChartScale& scale) {
  std::vector<std::vector<Px>> lines;
  const std::span<const Sample> all = series.samples;
  for (std::size_t from = 0; from < all.size();) {
    if (!is_finite(all[from])) {
      ++from;
      continue;
    }
    std::size_t to = from;
    while (to < all.size() && is_finite(all[to])) ++to;
    const std::span<const Sample> stretch = all.subspan(from, to - from);
    std::vector<Px> points;
    if (series.steps) {
      points = steps_of(stretch, scale);
    } else {
      for (const Sample& sample : stretch)
        points.push_back({scale.x(sample.t_s), scale.y(sample.value)});
    }
    lines.push_back(thinned(points));
    from = to;
  }
  return lines;
}

void spread_labels(std::span<double> centers, double height, double top, double bottom) {
  std::vector<std::size_t> order(centers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return centers[i]; });
  double least = top + height / 2;
  for (const std::size_t i : order) {
    centers[i] = std::max(centers[i], least);
    least = centers[i] + height;
  }
  double most = bottom - height / 2;
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    centers[*i] = std::min(centers[*i], most);
    most = centers[*i] - height;
  }
}

}  // namespace zonepack::report
