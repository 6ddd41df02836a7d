// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/slice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "packer/outline/map_server.hpp"

namespace zonepack::packer {
namespace {

constexpr double kFloorNoise_m = 0.15;
constexpr int kStrayShare = 10;
constexpr double kGap_m = 0.25;
constexpr double kEdge_m = 0.5;
constexpr double kCoarsest_m = 1;

std::int64_t edge_cells(double cell_m) { return std::llround(kEdge_m / cell_m); }

void count_up(std::uint8_t& count) {
  if (count < std::numeric_limits<std::uint8_t>::max()) ++count;
}

// Along one line of cells: where `value` ends and begins again after at most `most` cells, all of
// which `may` change, they become it.
template <typename May>
void close_gaps_along(MapImage& image, std::size_t first, std::size_t step, std::size_t count,
                      Cell value, std::size_t most, const May& may) {
  std::size_t open = count;  // the first cell of the gap; count: none is open
  for (std::size_t i = 0; i < count; ++i) {
    const Cell cell = image.cells[first + i * step];
    if (cell == value) {
      if (open < i && i - open <= most) {
        for (std::size_t k = open; k < i; ++k) image.cells[first + k * step] = value;
      }
      open = i + 1;
    } else if (!may(cell)) {
      open = count;
    }
  }
}

template <typename May>
void close_gaps(MapImage& image, Cell value, const May& may) {
  const auto most = static_cast<std::size_t>(kGap_m / image.resolution_m + 1e-9);
  for (std::size_t y = 0; y < image.height; ++y) {
    close_gaps_along(image, y * image.width, 1, image.width, value, most, may);
  }
  for (std::size_t x = 0; x < image.width; ++x) {
    close_gaps_along(image, x, image.width, image.height, value, most, may);
  }
}

}  // namespace

Slice::Slice(FloorHeights floor, SliceHeights heights, double cell_m)
    : floor_(std::move(floor)), heights_(heights), cell_m_(cell_m) {
  constexpr auto kMostCells = static_cast<std::int64_t>(kMostServedCells);
  for (box_ = cells_around_floor(); box_.width() > kMostCells / box_.height();
       box_ = cells_around_floor()) {
    cell_m_ *= 2;
    if (cell_m_ <= kCoarsest_m) continue;
    throw NoFloorPlan("its floor lies in places so far apart that a plan would measure " +
                      std::to_string(box_.width()) + " x " + std::to_string(box_.height()) +
                      " cells; cut the map, or leave out what is far from the building");
  }
  counts_.resize(static_cast<std::size_t>(box_.width() * box_.height()));
}

Slice::Box Slice::cells_around_floor() const {
  constexpr auto kLast = std::numeric_limits<std::int32_t>::max();
  FloorSquare low{kLast, kLast}, high{-kLast, -kLast};
  for (const auto& [square, z] : floor_.z_m) {
    low = {std::min(low.x, square.x), std::min(low.y, square.y)};
    high = {std::max(high.x, square.x), std::max(high.y, square.y)};
  }
  const auto from = [this](std::int32_t square) {
    return static_cast<std::int64_t>(std::floor(square * kFloorSquare_m / cell_m_));
  };
  const std::int64_t edge = edge_cells(cell_m_);
  return {from(low.x) - edge, from(low.y) - edge, from(high.x + 1) + 1 + edge,
          from(high.y + 1) + 1 + edge};
}

std::size_t Slice::place_of(std::int64_t x, std::int64_t y) const {
  return static_cast<std::size_t>((y - box_.y0) * box_.width() + (x - box_.x0));
}

void Slice::add(double x_m, double y_m, double z_m, Seen seen) {
  const FloorSquare square = floor_square_of(x_m, y_m);
  if (!any_ || !(square == last_square_)) {
    any_ = true;
    last_square_ = square;
    last_z_m_ = floor_.at(square);
  }
  if (!last_z_m_) return;
  const double above_m = z_m - *last_z_m_;
  const bool between = above_m >= heights_.low_m && above_m <= heights_.high_m;
  const bool floor = std::abs(above_m) < std::min(kFloorNoise_m, heights_.low_m);
  if (!between && !(floor && seen == Seen::kSurface)) return;
  Counts& cell = counts_[place_of(static_cast<std::int64_t>(std::floor(x_m / cell_m_)),
                                  static_cast<std::int64_t>(std::floor(y_m / cell_m_)))];
  if (seen == Seen::kFree) {
    cell.clear = std::max<std::uint8_t>(cell.clear, 1);  // empty space outvotes no surface
  } else {
    count_up(between ? cell.blocked : cell.clear);
  }
}

Slice::Box Slice::seen_box() const {
  Box seen{INT64_MAX, INT64_MAX, INT64_MIN, INT64_MIN};
  for (std::int64_t y = box_.y0; y < box_.y1; ++y) {
    for (std::int64_t x = box_.x0; x < box_.x1; ++x) {
      const Counts& cell = counts_[place_of(x, y)];
      if (cell.clear == 0 && cell.blocked == 0) continue;
      seen = {std::min(seen.x0, x), std::min(seen.y0, y), std::max(seen.x1, x + 1),
              std::max(seen.y1, y + 1)};
    }
  }
  return seen;
}

MapImage Slice::image() const {
  MapImage image;
  image.resolution_m = cell_m_;
  const Box seen = seen_box();
  if (seen.x0 >= seen.x1) return image;
  const std::int64_t margin = edge_cells(cell_m_);
  image.width = static_cast<std::size_t>(seen.width() + 2 * margin);
  image.height = static_cast<std::size_t>(seen.height() + 2 * margin);
  image.x_min_m = static_cast<double>(seen.x0 - margin) * cell_m_;
  image.y_min_m = static_cast<double>(seen.y0 - margin) * cell_m_;
  image.cells.assign(image.width * image.height, Cell::kUnknown);
  for (std::int64_t y = seen.y0; y < seen.y1; ++y) {
    auto to = static_cast<std::size_t>(y - seen.y0 + margin) * image.width +
              static_cast<std::size_t>(margin);
    for (std::int64_t x = seen.x0; x < seen.x1; ++x, ++to) {
      const Counts& cell = counts_[place_of(x, y)];
      if (cell.blocked > 0 && cell.blocked * kStrayShare >= cell.clear) {
        image.cells[to] = Cell::kOccupied;
      } else if (cell.clear > 0) {
        image.cells[to] = Cell::kFree;
      }
    }
  }
  close_gaps(image, Cell::kOccupied, [](Cell) { return true; });
  close_gaps(image, Cell::kFree, [](Cell cell) { return cell == Cell::kUnknown; });
  return image;
}

}  // namespace zonepack::packer
