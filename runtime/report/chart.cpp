// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/chart.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/report/chart_scale.hpp"
#include "runtime/report/format.hpp"
#include "runtime/report/legend.hpp"

namespace zonepack::report {
namespace {

constexpr double kTitle = 24, kBand = 18, kAxisBelow = 38;
constexpr double kRoomy_px = 500;  // a chart this wide has wide margins
constexpr double kTimeTick_px = 70;
constexpr int kTicks = 6;
constexpr double kSmall = 11, kTiny = 8, kEndLabel = 15;

std::vector<LegendItem> legend_of(const Chart& chart) {
  std::vector<LegendItem> items;
  for (const ChartSeries& series : chart.series) {
    items.push_back({series.compared ? Mark::kLine : Mark::kThickLine, series.color, series.name});
  }
  if (chart.limit) items.push_back({Mark::kDashedLine, kLimit, chart.limit->name});
  for (const ChartShade& shade : chart.shades) {
    if (!shade.spans.empty()) {
      items.push_back({Mark::kBlock, mix(kWhite, shade.color, 0.3), shade.name});
    }
  }
  return items;
}

// Of spans that begin within half a pixel after the one before ends, none is seen: one of them is
// drawn, so that a page stays small however often a flag changed.
class Crowd {
 public:
  bool hides(double from, double to) noexcept {
    if (to < last_ + 0.5) return true;
    last_ = std::max(to, from + 0.5);
    return false;
  }

 private:
  double last_ = -1;
};

void draw_shades(Svg& svg, const Chart& chart, const ChartScale& scale) {
  for (auto shade = chart.shades.rbegin(); shade != chart.shades.rend(); ++shade) {
    Crowd crowd;
    for (const TimeSpan& span : shade->spans) {
      const double from = scale.x(span.from_s);
      if (crowd.hides(from, std::max(scale.x(span.to_s), from + 1))) continue;
      svg.rect({from, scale.top}, std::max(scale.x(span.to_s) - from, 1.0), scale.height,
               {.fill = mix(kWhite, shade->color, 0.3), .hint = shade->name});
    }
  }
}

void draw_grid(Svg& svg, const Chart& chart, const ChartScale& scale) {
  const Ticks values = make_ticks(0, scale.most, kTicks, chart.quantity);
  for (std::size_t i = 0; i < values.values.size(); ++i) {
    const double y = scale.y(values.values[i]);
    svg.line({scale.left, y}, {scale.right(), y}, {.stroke = i == 0 ? kWall : kFaint});
    const std::string label = values.values[i] == 0 ? "0" : values.labels[i] + chart.unit;
    svg.text({scale.left - 8, y + 4}, label,
             {.size = kSmall, .color = kQuiet, .anchor = Anchor::kEnd});
  }
  Crowd crowd;
  for (std::size_t i = 1; i < chart.timeline.size(); ++i) {
    const double x = scale.x(chart.timeline[i].span.from_s);
    if (crowd.hides(x, x)) continue;
    svg.line({x, scale.top}, {x, scale.bottom()}, {.stroke = kFaint});
  }
}

void draw_time_axis(Svg& svg, const Chart& chart, const ChartScale& scale, double y) {
  const Ticks times = make_ticks(0, scale.duration_s, static_cast<int>(scale.width / kTimeTick_px),
                                 chart.axis_quantity);
  for (std::size_t i = 0; i < times.values.size(); ++i) {
    const double x = scale.x(times.values[i]);
    svg.line({x, y}, {x, y + 4}, {.stroke = kWall});
    svg.text({x, y + 17}, times.labels[i],
             {.size = kSmall, .color = kQuiet, .anchor = Anchor::kMiddle});
  }
  svg.text({scale.right(), y + 32}, chart.axis,
           {.size = kSmall, .color = kQuiet, .anchor = Anchor::kEnd});
}

void draw_timeline(Svg& svg, const Chart& chart, const ChartScale& scale) {
  svg.text({scale.left - 8, scale.bottom() + 4 + kBand - 5}, "zone",
           {.size = kSmall, .color = kQuiet, .anchor = Anchor::kEnd});
  Crowd crowd;
  for (const TimelineBlock& block : chart.timeline) {
    const double from = scale.x(block.span.from_s);
    const double width = scale.x(block.span.to_s) - from;
    if (crowd.hides(from, from + width)) continue;
    const std::string hint = block.name + ": " + format_number(block.span.from_s, 1) + " to " +
                             format_number(block.span.to_s, 1) + " s";
    svg.rect({from, scale.bottom() + 4}, std::max(width, 0.5), kBand,
             {.fill = block.color, .stroke = kWhite, .stroke_width = 0.75, .hint = hint});
    const double em = text_width_em(block.name, true);
    const double size = em * kSmall + 4 <= width ? kSmall : kTiny;
    if (em * size + 2 > width) continue;
    svg.text({from + width / 2, scale.bottom() + 4 + kBand / 2 + size * 0.37}, block.name,
             {.size = size,
              .color = ink_on(block.color),
              .bold = true,
              .anchor = Anchor::kMiddle,
              .on_color = true});
  }
}

void draw_limit(Svg& svg, const Chart& chart, const ChartScale& scale) {
  if (!chart.limit) return;
  const double y = scale.y(chart.limit->value);
  svg.line({scale.left, y}, {scale.right(), y},
           {.stroke = kLimit, .stroke_width = 1.5, .dash = "6 4", .hint = chart.limit->name});
}

void draw_series(Svg& svg, const Chart& chart, const ChartScale& scale) {
  for (const bool compared : {true, false}) {
    for (const ChartSeries& series : chart.series) {
      if (series.compared != compared) continue;
      for (const std::vector<Px>& line : series_lines(series, scale)) {
        svg.polyline(line, {.stroke = series.color,
                            .stroke_width = compared ? 1.75 : 2.5,
                            .round = true,
                            .hint = series.name});
      }
    }
  }
}

// The last value of every series, and the limit, in their colours next to the end of their lines.
void draw_end_values(Svg& svg, const Chart& chart, const ChartScale& scale) {
  struct Label {
    std::string text;
    Color color;
  };
  std::vector<Label> labels;
  std::vector<double> centers;
  for (const ChartSeries& series : chart.series) {
    const auto last = std::find_if(series.samples.rbegin(), series.samples.rend(),
                                   [](const Sample& s) { return std::isfinite(s.value); });
    if (last == series.samples.rend()) continue;
    labels.push_back({end_value(chart, last->value), mix(series.color, kInk, 0.2)});
    centers.push_back(scale.y(last->value));
  }
  if (chart.limit) {
    labels.push_back({end_value(chart, chart.limit->value), kLimit});
    centers.push_back(scale.y(chart.limit->value));
  }
  spread_labels(centers, kEndLabel, scale.top - kEndLabel / 2, scale.bottom() + kEndLabel / 2);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    svg.text({scale.right() + 7, centers[i] + 4}, labels[i].text,
             {.size = 12, .color = labels[i].color, .bold = true});
  }
}

}  // namespace

std::string end_value(const Chart& chart, double value) {
  if (chart.quantity == Quantity::kBytes) return format_bytes(value);
  return format_number(value, chart.unit.empty() ? 0 : 2) + chart.unit;
}

Chart narrowed(Chart chart) {
  chart.width_px = kNarrowWidth_px;
  return chart;
}

Svg draw_chart(const Chart& chart) {
  const std::vector<LegendItem> legend = legend_of(chart);
  ChartScale scale;
  const bool roomy = chart.width_px >= kRoomy_px;
  scale.left = roomy ? 72 : 60;
  scale.width = chart.width_px - scale.left - (roomy ? 84 : 66);
  scale.top = (chart.title.empty() ? 0 : kTitle) + legend_height(scale.width, legend) + 10;
  scale.height = chart.plot_height_px;
  scale.duration_s = last_time_s(chart);
  scale.most = round_up_to_tick(largest_value(chart) * 1.04, kTicks, chart.quantity);
  const double band = chart.timeline.empty() ? 0 : kBand + 6;

  Svg svg(chart.width_px, scale.bottom() + band + kAxisBelow);
  svg.text({scale.left, 14}, chart.title, {.size = 14, .bold = true});
  draw_legend(svg, {scale.left, chart.title.empty() ? 0 : kTitle}, scale.width, legend);
  draw_shades(svg, chart, scale);
  draw_grid(svg, chart, scale);
  draw_limit(svg, chart, scale);
  draw_series(svg, chart, scale);
  if (!chart.timeline.empty()) draw_timeline(svg, chart, scale);
  draw_time_axis(svg, chart, scale, scale.bottom() + band);
  draw_end_values(svg, chart, scale);
  std::string plot;
  for (const double value :
       {scale.left, scale.top, scale.width, scale.height, scale.duration_s, scale.most}) {
    plot += (plot.empty() ? "" : " ") + format_number(value, 3);
  }
  svg.set_data("plot", plot);
  return svg;
}

}  // namespace zonepack::report
