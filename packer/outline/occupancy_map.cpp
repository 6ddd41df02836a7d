// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace zonepack::packer {
namespace {

// Log odds in thousandths: ln(0.7 / 0.3), ln(0.4 / 0.6), ln(0.12 / 0.88), ln(0.97 / 0.03).
constexpr int kHit = 847, kMiss = -405, kLeast = -1992, kMost = 3476;
constexpr double kReach_m = 100;
constexpr double kMargin_m = 0.5;
constexpr std::int64_t kMaxCells = std::int64_t{1} << 29;
constexpr std::int32_t kMatrixFloat32 = 5;  // OpenCV's depth

std::int64_t floor_div(std::int64_t a, std::int64_t b) { return (a >= 0 ? a : a - b + 1) / b; }

// Calls fn(x, y, z) for each cell, base frame.
template <typename Fn>
void for_each_cell(const Matrix& cells, Fn&& fn) {
  const auto channels = static_cast<std::size_t>(cells.type >> 3) + 1;
  if ((cells.type & 7) != kMatrixFloat32 || channels < 2) return;
  const std::size_t stride = channels * sizeof(float);
  for (std::size_t at = 0; at + stride <= cells.data.size(); at += stride) {
    std::array<float, 3> p{};
    std::memcpy(p.data(), cells.data.data() + at,
                std::min<std::size_t>(channels, 3) * sizeof(float));
    const double x = p[0], y = p[1], z = p[2];
    if (std::abs(x) <= kReach_m && std::abs(y) <= kReach_m && std::abs(z) <= kReach_m) fn(x, y, z);
  }
}

}  // namespace

OccupancyMap::OccupancyMap(double resolution_m) : resolution_m_(resolution_m) {}

OccupancyMap::Index OccupancyMap::index_of(double x_m, double y_m) const {
  return {static_cast<std::int64_t>(std::floor(x_m / resolution_m_)),
          static_cast<std::int64_t>(std::floor(y_m / resolution_m_))};
}

void OccupancyMap::vote(Index index, int evidence) {
  const std::int64_t tile_x = floor_div(index.x, kTile), tile_y = floor_div(index.y, kTile);
  const auto [it, fresh] = tiles_.try_emplace({tile_y, tile_x});
  if (fresh) it->second.fill(kUnseen);
  std::int16_t& cell = it->second[static_cast<std::size_t>((index.y - tile_y * kTile) * kTile +
                                                           (index.x - tile_x * kTile))];
  const int before = cell == kUnseen ? 0 : cell;
  cell = static_cast<std::int16_t>(std::clamp(before + evidence, kLeast, kMost));
}

std::vector<OccupancyMap::Index> OccupancyMap::obstacles(const Matrix& cells,
                                                         const Transform& T) const {
  std::vector<Index> found;
  for_each_cell(cells, [&](double x, double y, double z) {
    found.push_back(
        index_of(T[0] * x + T[1] * y + T[2] * z + T[3], T[4] * x + T[5] * y + T[6] * z + T[7]));
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void OccupancyMap::add_free(std::span<const std::pair<double, double>> p_base, double cell_m,
                            const Transform& T, const std::vector<Index>& occupied) {
  const double determinant = T[0] * T[5] - T[1] * T[4];
  if (p_base.empty() || determinant < 0.5) return;  // no robot drives on its side
  double x0 = kReach_m, y0 = kReach_m, x1 = -kReach_m, y1 = -kReach_m;
  for (const auto& [x, y] : p_base) {
    x0 = std::min(x0, x);
    y0 = std::min(y0, y);
    x1 = std::max(x1, x);
    y1 = std::max(y1, y);
  }
  const auto local = [cell_m](double v, double v0) { return std::llround((v - v0) / cell_m); };
  const std::int64_t columns = local(x1, x0) + 1, rows = local(y1, y0) + 1;
  std::vector<bool> seen(static_cast<std::size_t>(columns * rows));
  for (const auto& [x, y] : p_base) {
    seen[static_cast<std::size_t>(local(y, y0) * columns + local(x, x0))] = true;
  }

  Index low{INT64_MAX, INT64_MAX}, high{INT64_MIN, INT64_MIN};
  for (const double x : {x0 - cell_m, x1 + cell_m}) {
    for (const double y : {y0 - cell_m, y1 + cell_m}) {
      const Index corner = index_of(T[0] * x + T[1] * y + T[3], T[4] * x + T[5] * y + T[7]);
      low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
      high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
    }
  }
  for (std::int64_t j = low.y; j <= high.y; ++j) {
    for (std::int64_t i = low.x; i <= high.x; ++i) {
      const double dx = (static_cast<double>(i) + 0.5) * resolution_m_ - T[3];
      const double dy = (static_cast<double>(j) + 0.5) * resolution_m_ - T[7];
      const std::int64_t column = local((T[5] * dx - T[1] * dy) / determinant, x0);
      const std::int64_t row = local((T[0] * dy - T[4] * dx) / determinant, y0);
      if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
      if (!seen[static_cast<std::size_t>(row * columns + column)]) continue;
      if (!std::binary_search(occupied.begin(), occupied.end(), Index{i, j})) vote({i, j}, kMiss);
    }
  }
}

void OccupancyMap::add(const Grid& grid, const Transform& T_map_base) {
  if (!(grid.cell_size > 0.001f && grid.cell_size < 10.0f)) return;
  std::vector<Index> occupied;
  if (grid.obstacle) occupied = obstacles(*grid.obstacle, T_map_base);
  std::vector<std::pair<double, double>> free;
  for (const auto* cells : {&grid.ground, &grid.empty}) {
    if (!*cells) continue;
    for_each_cell(**cells, [&](double x, double y, double) { free.emplace_back(x, y); });
  }
  add_free(free, grid.cell_size, T_map_base, occupied);
  for (const Index index : occupied) vote(index, kHit);
}

MapImage OccupancyMap::image() const {
  Index low{INT64_MAX, INT64_MAX}, high{INT64_MIN, INT64_MIN};
  const auto for_each_seen = [this](auto&& fn) {
    for (const auto& [place, tile] : tiles_) {
      for (std::int64_t k = 0; k < kTile * kTile; ++k) {
        const std::int16_t evidence = tile[static_cast<std::size_t>(k)];
        if (evidence == kUnseen) continue;
        fn(Index{place.second * kTile + k % kTile, place.first * kTile + k / kTile}, evidence);
      }
    }
  };
  for_each_seen([&](Index index, std::int16_t) {
    low = {std::min(low.x, index.x), std::min(low.y, index.y)};
    high = {std::max(high.x, index.x), std::max(high.y, index.y)};
  });
  MapImage image;
  image.resolution_m = resolution_m_;
  if (low.x > high.x) return image;

  const auto margin = std::llround(kMargin_m / resolution_m_);
  low = {low.x - margin, low.y - margin};
  const std::int64_t width = high.x + margin - low.x + 1, height = high.y + margin - low.y + 1;
  if (width > kMaxCells / height) {
    throw std::runtime_error("the map would measure " + std::to_string(width) + " x " +
                             std::to_string(height) +
                             " cells; some signature stands far off the others: look at its pose");
  }
  image.width = static_cast<std::size_t>(width);
  image.height = static_cast<std::size_t>(height);
  image.x_min_m = static_cast<double>(low.x) * resolution_m_;
  image.y_min_m = static_cast<double>(low.y) * resolution_m_;
  image.cells.assign(image.width * image.height, Cell::kUnknown);
  for_each_seen([&](Index index, std::int16_t evidence) {
    image.cells[static_cast<std::size_t>((index.y - low.y) * width + (index.x - low.x))] =
        evidence >= 0 ? Cell::kOccupied : Cell::kFree;
  });
  return image;
}

}  // namespace zonepack::packer
