// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "runtime/report/svg.hpp"

namespace zonepack::report {

enum class Mark { kLine, kThickLine, kDashedLine, kDot, kBigDot, kRing, kBlock, kRamp };

struct LegendItem {
  Mark mark = Mark::kLine;
  Color color = kInk;
  std::string text;
};

inline constexpr double kLegendRow = 20;  // pixels

// Draws the items from left to right below `corner`, starting a new row where `width` ends.
// Returns the height used, a multiple of kLegendRow.
double draw_legend(Svg& svg, Px corner, double width, std::span<const LegendItem> items);

// The height draw_legend will use.
double legend_height(double width, std::span<const LegendItem> items);

}  // namespace zonepack::report
