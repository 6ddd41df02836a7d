// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/legend.hpp"

#include "runtime/report/format.hpp"

namespace zonepack::report {
namespace {

constexpr double kTextSize = 12;
constexpr double kGap = 6;       // between mark and text
constexpr double kBetween = 20;  // between items

double mark_width(Mark mark) noexcept {
  switch (mark) {
    case Mark::kDot:
      return 8;
    case Mark::kBigDot:
    case Mark::kRing:
      return 10;
    case Mark::kBlock:
      return 14;
    case Mark::kRamp:
      return 120;
    default:
      return 22;
  }
}

void draw_mark(Svg& svg, Px left, const LegendItem& item) {
  const double width = mark_width(item.mark);
  const Px right{left.x + width, left.y};
  switch (item.mark) {
    case Mark::kLine:
      svg.line(left, right, {.stroke = item.color, .stroke_width = 2});
      break;
    case Mark::kThickLine:
      svg.line(left, right, {.stroke = item.color, .stroke_width = 4});
      break;
    case Mark::kDashedLine:
      svg.line(left, right, {.stroke = item.color, .stroke_width = 1.5, .dash = "5 3"});
      break;
    case Mark::kDot:
      svg.circle({left.x + 4, left.y}, 2.5, {.fill = item.color});
      break;
    case Mark::kBigDot:
      svg.circle({left.x + 5, left.y}, 4, {.fill = item.color});
      break;
    case Mark::kRing:
      svg.circle({left.x + 5, left.y}, 4.5, {.stroke = item.color, .stroke_width = 1.5});
      break;
    case Mark::kBlock:
      svg.rect({left.x, left.y - 6}, width, 12, {.fill = item.color});
      break;
    case Mark::kRamp: {
      constexpr int kSteps = 24;
      for (int i = 0; i < kSteps; ++i) {
        svg.rect({left.x + width * i / kSteps, left.y - 6}, width / kSteps + 0.5, 12,
                 {.fill = ramp_color((i + 0.5) / kSteps)});
      }
      svg.rect({left.x, left.y - 6}, width + 0.5, 12, {.stroke = kWall, .stroke_width = 0.75});
    }
  }
}

// Visits the positions of the items; draws them when `svg` is given.
double lay_out(Svg* svg, Px corner, double width, std::span<const LegendItem> items) {
  Px at{corner.x, corner.y + kLegendRow / 2};
  for (const LegendItem& item : items) {
    const double text_at = mark_width(item.mark) + kGap;
    const double taken = text_at + text_width_em(item.text) * kTextSize;
    if (at.x > corner.x && at.x + taken > corner.x + width) at = {corner.x, at.y + kLegendRow};
    if (svg != nullptr) {
      draw_mark(*svg, at, item);
      svg->text({at.x + text_at, at.y + 4}, item.text, {.size = kTextSize});
    }
    at.x += taken + kBetween;
  }
  return items.empty() ? 0 : at.y - corner.y + kLegendRow / 2;
}

}  // namespace

double draw_legend(Svg& svg, Px corner, double width, std::span<const LegendItem> items) {
  return lay_out(&svg, corner, width, items);
}

double legend_height(double width, std::span<const LegendItem> items) {
  return lay_out(nullptr, {}, width, items);
}

}  // namespace zonepack::report
