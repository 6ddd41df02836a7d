// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "runtime/report/chart.hpp"
#include "runtime/report/script_json.hpp"
#include "runtime/report/thinning.hpp"

namespace zonepack::report {
namespace {

constexpr double kMsPerSecond = 1000;
constexpr double kPerUnit = 1000;         // of a value with a unit, such as metres
constexpr double kLineTolerance = 0.001;  // of such a value

std::vector<Sample> fewer_of(const ChartSeries& series) {
  if (series.steps) return changes_of(series.samples, kMostSeriesPoints);
  std::vector<Waypoint> points;
  points.reserve(series.samples.size());
  for (const Sample& sample : series.samples) points.push_back({sample.t_s, {sample.value}});
  std::vector<Sample> samples;
  for (const std::size_t i : corners_of(points, {kLineTolerance, 1, 1}, kMostSeriesPoints)) {
    samples.push_back(series.samples[i]);
  }
  return samples;
}

std::string series_json(const Chart& chart, const ChartSeries& series) {
  const double per_unit = chart.unit.empty() ? 1 : kPerUnit;
  std::vector<double> times, values;
  for (const Sample& sample : fewer_of(series)) {
    times.push_back(std::isfinite(sample.t_s) ? sample.t_s : 0);
    values.push_back(sample.value);
  }
  return "{\"name\":" + script_string(series.name) +
         ",\"color\":" + script_string(to_hex(series.color)) +
         ",\"steps\":" + (series.steps ? "true" : "false") +
         ",\"per\":" + std::to_string(static_cast<int>(per_unit)) +
         ",\"t\":" + script_differences(times, kMsPerSecond) +
         ",\"v\":" + script_differences(values, per_unit) + "}";
}

}  // namespace

std::string chart_json(const Chart& chart) {
  std::string json = "{\"kind\":\"chart\",\"bytes\":";
  json += chart.quantity == Quantity::kBytes ? "true" : "false";
  json += ",\"unit\":" + script_string(chart.unit) + ",\"series\":[";
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    if (i > 0) json += ',';
    json += series_json(chart, chart.series[i]);
  }
  return json + "]}";
}

}  // namespace zonepack::report
