// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace zonepack::packer::suggest {
namespace {

// A longer island is a wall if it is thinner than kThin_m over its length or, where walls meet in
// it, if all of them together are thinner than kThinArms_m.
constexpr double kWallLength_m = 1.0, kThin_m = 0.35, kThinArms_m = 0.32;

struct Island {
  std::vector<CellIndex> cells;
  std::int32_t left = INT32_MAX, right = -1, low = INT32_MAX, high = -1;
  bool at_edge = false;
};

Island flood(const FreeSpace& space, CellIndex start, std::vector<std::uint8_t>& seen) {
  Island island;
  island.cells.push_back(start);
  seen[static_cast<std::size_t>(start)] = 1;
  for (std::size_t next = 0; next < island.cells.size(); ++next) {
    const CellIndex cell = island.cells[next];
    const std::int32_t x = cell % space.columns, y = cell / space.columns;
    island.left = std::min(island.left, x);
    island.right = std::max(island.right, x);
    island.low = std::min(island.low, y);
    island.high = std::max(island.high, y);
    if (x == 0 || y == 0 || x == space.columns - 1 || y == space.rows - 1) island.at_edge = true;
    for (std::int32_t v = std::max(y - 1, 0); v <= std::min(y + 1, space.rows - 1); ++v) {
      for (std::int32_t u = std::max(x - 1, 0); u <= std::min(x + 1, space.columns - 1); ++u) {
        const CellIndex near = space.at(u, v);
        if (space.is_free(near) || seen[static_cast<std::size_t>(near)] != 0) continue;
        seen[static_cast<std::size_t>(near)] = 1;
        island.cells.push_back(near);
      }
    }
  }
  return island;
}

// The mean width of its arms: a strip's cells lie a quarter of that from its edge, however it
// bends.
double thickness_m(const Island& island, const FreeSpace& space) {
  FreeSpace box;  // with a margin around the island
  box.columns = island.right - island.left + 3;
  box.rows = island.high - island.low + 3;
  box.free.resize(static_cast<std::size_t>(box.columns) * static_cast<std::size_t>(box.rows));
  for (const CellIndex cell : island.cells) {
    const std::int32_t x = cell % space.columns - island.left + 1;
    const std::int32_t y = cell / space.columns - island.low + 1;
    box.free[static_cast<std::size_t>(box.at(x, y))] = 1;
  }
  double sum = 0;
  for (const std::int32_t depth2 : squared_clearance(box)) sum += std::sqrt(depth2);
  return 4 * (sum / static_cast<double>(island.cells.size()) - 0.5) * space.cell_m;
}

bool is_wall(const Island& island, const FreeSpace& space) {
  const double wide = static_cast<double>(island.right - island.left + 1) * space.cell_m;
  const double high = static_cast<double>(island.high - island.low + 1) * space.cell_m;
  const double diagonal2 = wide * wide + high * high;
  if (diagonal2 < kWallLength_m * kWallLength_m) return false;
  const double area = space.area_m2(island.cells.size());
  if (area * area < kThin_m * kThin_m * diagonal2) return true;  // area / length
  return thickness_m(island, space) < kThinArms_m;
}

}  // namespace

void remove_clutter(FreeSpace& space, double most_m2) {
  std::vector<std::uint8_t> seen(space.size());
  for (std::size_t i = 0; i < space.size(); ++i) {
    if (space.free[i] != 0 || seen[i] != 0) continue;
    const Island island = flood(space, static_cast<CellIndex>(i), seen);
    if (island.at_edge || space.area_m2(island.cells.size()) >= most_m2) continue;
    if (is_wall(island, space)) continue;
    for (const CellIndex cell : island.cells) space.free[static_cast<std::size_t>(cell)] = 1;
  }
}

std::vector<std::int32_t> squared_clearance(const FreeSpace& space) {
  const std::int32_t columns = space.columns, rows = space.rows;
  // The outermost rows are not free, so no distance along a column exceeds this.
  std::vector<std::int32_t> down(space.size());
  for (std::int32_t x = 0; x < columns; ++x) {
    for (std::int32_t y = 1; y < rows; ++y) {
      const auto cell = static_cast<std::size_t>(space.at(x, y));
      const auto below = static_cast<std::size_t>(space.at(x, y - 1));
      down[cell] = space.free[cell] != 0 ? down[below] + 1 : 0;
    }
    for (std::int32_t y = rows - 1; y-- > 0;) {
      const auto cell = static_cast<std::size_t>(space.at(x, y));
      const auto above = static_cast<std::size_t>(space.at(x, y + 1));
      down[cell] = std::min(down[cell], down[above] + 1);
    }
  }
  std::vector<std::int32_t> clearance(space.size());
  std::vector<std::int32_t> centre(static_cast<std::size_t>(columns));
  std::vector<std::int32_t> from(static_cast<std::size_t>(columns));
  for (std::int32_t y = 0; y < rows; ++y) {
    const auto g2 = [&](std::int32_t x) {
      const std::int64_t g = down[static_cast<std::size_t>(space.at(x, y))];
      return g * g;
    };
    const auto f = [&](std::int32_t x, std::int32_t i) {
      return std::int64_t{x - i} * (x - i) + g2(i);
    };
    std::size_t top = 0;
    centre[0] = 0;
    from[0] = 0;
    for (std::int32_t u = 1; u < columns; ++u) {
      bool empty = false;
      while (f(from[top], centre[top]) > f(from[top], u)) {
        if (top == 0) {
          empty = true;
          break;
        }
        --top;
      }
      if (empty) {
        centre[0] = u;
        continue;
      }
      const std::int32_t i = centre[top];
      // The last place where i is at least as near as u; the numerator is never negative here.
      const std::int64_t w = 1 + (std::int64_t{u} * u - std::int64_t{i} * i + g2(u) - g2(i)) /
                                     (std::int64_t{2} * (u - i));
      if (w >= columns) continue;
      ++top;
      centre[top] = u;
      from[top] = static_cast<std::int32_t>(w);
    }
    for (std::int32_t u = columns; u-- > 0;) {
      clearance[static_cast<std::size_t>(space.at(u, y))] =
          static_cast<std::int32_t>(f(u, centre[top]));
      if (u == from[top] && top > 0) --top;
    }
  }
  return clearance;
}

}  // namespace zonepack::packer::suggest
