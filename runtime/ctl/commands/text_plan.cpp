// SPDX-License-Identifier: Apache-2.0
#include "runtime/ctl/commands/text_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

constexpr double kHeight = 2;  // of a character, in its widths

// Even-odd rule.
bool is_inside(const TextPlan::Outline& outline, TextPlan::Point p) noexcept {
  bool inside = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const TextPlan::Point a = outline[i], b = outline[j];
    if ((a.y_m > p.y_m) == (b.y_m > p.y_m)) continue;
    if (p.x_m < a.x_m + (b.x_m - a.x_m) * (p.y_m - a.y_m) / (b.y_m - a.y_m)) inside = !inside;
  }
  return inside;
}

std::string_view environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace

TextPlan::TextPlan(std::vector<Outline> zones, bool utf8) : zones_(std::move(zones)), utf8_(utf8) {
  constexpr double kFar = std::numeric_limits<double>::max();
  low_ = {kFar, kFar};
  high_ = {-kFar, -kFar};
  bool any = false;
  for (const Outline& outline : zones_) {
    std::pair<Point, Point> box{{kFar, kFar}, {-kFar, -kFar}};
    for (const Point p : outline) {
      box.first = {std::min(box.first.x_m, p.x_m), std::min(box.first.y_m, p.y_m)};
      box.second = {std::max(box.second.x_m, p.x_m), std::max(box.second.y_m, p.y_m)};
    }
    boxes_.push_back(box);
    if (outline.empty()) continue;
    any = true;
    low_ = {std::min(low_.x_m, box.first.x_m), std::min(low_.y_m, box.first.y_m)};
    high_ = {std::max(high_.x_m, box.second.x_m), std::max(high_.y_m, box.second.y_m)};
  }
  const double reach = any ? std::max(high_.x_m - low_.x_m, high_.y_m - low_.y_m) : 0;
  if (!(reach > 0 && std::isfinite(reach))) zones_.clear();
}

std::size_t TextPlan::zone_of(Point p) const noexcept {
  for (std::size_t i = 0; i < zones_.size(); ++i) {
    const auto& [low, high] = boxes_[i];
    if (p.x_m < low.x_m || p.x_m > high.x_m || p.y_m < low.y_m || p.y_m > high.y_m) continue;
    if (is_inside(zones_[i], p)) return i;
  }
  return kNothing;
}

void TextPlan::rasterise(Size size) const {
  if (raster_.size.columns == size.columns && raster_.size.rows == size.rows) return;
  raster_.size = size;
  const double width_m = high_.x_m - low_.x_m, height_m = high_.y_m - low_.y_m;
  raster_.column_m = std::max(width_m / size.columns, height_m / (kHeight * size.rows));
  const double row_m = kHeight * raster_.column_m;
  // A hair less, so that a quotient that is whole does not get another column from rounding.
  const auto cells = [](double length_m, double cell_m, int most) {
    return std::clamp(static_cast<int>(std::ceil(length_m / cell_m - 1e-9)), 1, most);
  };
  raster_.columns = cells(width_m, raster_.column_m, size.columns);
  raster_.rows = cells(height_m, row_m, size.rows);
  raster_.zone_at.clear();
  for (int row = 0; row < raster_.rows; ++row) {
    for (int column = 0; column < raster_.columns; ++column) {
      raster_.zone_at.push_back(
          zone_of({low_.x_m + (column + 0.5) * raster_.column_m, high_.y_m - (row + 0.5) * row_m}));
    }
  }
}

std::size_t TextPlan::at(int column, int row) const noexcept {
  if (column < 0 || column >= raster_.columns || row < 0 || row >= raster_.rows) return kNothing;
  return raster_.zone_at[static_cast<std::size_t>(row) * static_cast<std::size_t>(raster_.columns) +
                         static_cast<std::size_t>(column)];
}

const char* TextPlan::glyph_of(Look look) const noexcept {
  switch (look) {
    case Look::kOwn:
      return utf8_ ? "▓" : "@";
    case Look::kResident:
      return utf8_ ? "▒" : "#";
    case Look::kFilling:
      return "+";
    case Look::kWanted:
      return "?";
    default:
      return utf8_ ? "·" : ".";
  }
}

const char* TextPlan::arrow_of(double yaw_rad) const noexcept {
  static constexpr const char* kArrows[] = {"→", "↗", "↑", "↖", "←", "↙", "↓", "↘"};
  static constexpr const char* kPlain[] = {">", "^", "<", "v"};
  const int directions = utf8_ ? 8 : 4;
  if (!std::isfinite(yaw_rad)) return "o";
  const double turn = yaw_rad / (2 * kPi);
  const int sector = static_cast<int>(std::floor((turn - std::floor(turn)) * directions + 0.5));
  return utf8_ ? kArrows[sector % directions] : kPlain[sector % directions];
}

int TextPlan::columns_in(int rows) const noexcept {
  const double width_m = high_.x_m - low_.x_m, height_m = high_.y_m - low_.y_m;
  constexpr double kMost = 1e6;  // of a map that is almost a line
  return static_cast<int>(std::min(std::ceil(kHeight * rows * width_m / height_m), kMost));
}

std::vector<ScreenLine> TextPlan::draw(Size size, const std::vector<Shade>& shades,
                                       const std::optional<Robot>& robot, bool color) const {
  std::vector<ScreenLine> lines;
  if (empty() || size.columns < 1 || size.rows < 1) return lines;
  rasterise(size);
  struct Cell {
    std::string glyph = " ";
    const char* style = nullptr;
  };
  std::vector<Cell> cells(raster_.zone_at.size());
  const auto cell = [&](int column, int row) -> Cell& {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(raster_.columns) +
                 static_cast<std::size_t>(column)];
  };
  // The longest runs of each zone, from the top: its name is put into the middle one.
  struct Run {
    int column = 0, row = 0, length = 0;
  };
  std::vector<std::vector<Run>> runs(shades.size());
  for (int row = 0; row < raster_.rows; ++row) {
    for (int column = 0, length = 0; column < raster_.columns; ++column) {
      const std::size_t zone = at(column, row);
      if (zone >= shades.size()) continue;
      const std::size_t left = at(column - 1, row);
      length = left == zone ? length + 1 : 1;
      // A wall between two zones takes the first character of the one to the right.
      const bool wall = left != zone && left != kNothing && at(column + 1, row) == zone;
      cell(column, row) = {wall ? (utf8_ ? "│" : "|") : glyph_of(shades[zone].look),
                           wall ? kDim : shades[zone].style};
      if (at(column + 1, row) == zone) continue;
      std::vector<Run>& best = runs[zone];
      if (!best.empty() && length > best.back().length) best.clear();
      if (best.empty() || length == best.back().length) {
        best.push_back({column - length + 1, row, length});
      }
    }
  }
  for (std::size_t zone = 0; zone < shades.size(); ++zone) {
    if (runs[zone].empty()) continue;
    const Run& run = runs[zone][(runs[zone].size() - 1) / 2];
    const auto name = static_cast<int>(shades[zone].name.size());
    if (name == 0 || name + 2 > run.length) continue;
    const int begin = run.column + (run.length - name + 1) / 2;
    for (int i = 0; i < name; ++i) {
      cell(begin + i, run.row) = {shades[zone].name.substr(static_cast<std::size_t>(i), 1),
                                  shades[zone].look == Look::kOwn ? kBold : shades[zone].style};
    }
  }
  if (robot) {
    const double column = std::floor((robot->x_m - low_.x_m) / raster_.column_m);
    const double row = std::floor((high_.y_m - robot->y_m) / (kHeight * raster_.column_m));
    if (column >= 0 && column < raster_.columns && row >= 0 && row < raster_.rows) {
      cell(static_cast<int>(column), static_cast<int>(row)) = {arrow_of(robot->yaw_rad), kRed};
    }
  }
  for (int row = 0; row < raster_.rows; ++row) {
    ScreenLine line(size.columns, color);
    for (int column = 0; column < raster_.columns; ++column) {
      line.add(cell(column, row).glyph, cell(column, row).style);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

bool terminal_shows_utf8() {
  for (const char* const name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const std::string_view value = environment(name);
    if (value.empty()) continue;
    return value.find("UTF-8") != value.npos || value.find("utf8") != value.npos ||
           value.find("UTF8") != value.npos || value.find("utf-8") != value.npos;
  }
  return false;
}

bool terminal_shows_color() {
  return environment("NO_COLOR").empty() && environment("TERM") != "dumb";
}

}  // namespace zonepack
