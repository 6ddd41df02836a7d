// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/regions.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

namespace zonepack::packer::suggest {
namespace {

std::array<CellIndex, 4> beside(CellIndex cell, const FreeSpace& space) noexcept {
  return {cell - space.columns, cell - 1, cell + 1, cell + space.columns};
}

// Calls fn(cell) for every cell that has four neighbours.
template <typename Fn>
void for_each_inner(const FreeSpace& space, Fn&& fn) {
  for (std::int32_t y = 1; y + 1 < space.rows; ++y) {
    for (std::int32_t x = 1; x + 1 < space.columns; ++x) fn(space.at(x, y));
  }
}

}  // namespace

std::vector<std::size_t> cells_of_each(const Regions& regions) {
  std::vector<std::size_t> cells(static_cast<std::size_t>(regions.count));
  for (const Region region : regions.of_cell) {
    if (region != kNoRegion) ++cells[static_cast<std::size_t>(region)];
  }
  return cells;
}

void renumber(Regions& regions, const FreeSpace& space) {
  std::vector<Region> fresh(space.size(), kNoRegion);
  regions.count = 0;
  std::vector<CellIndex> queue;
  for_each_inner(space, [&](CellIndex start) {
    const Region old = regions.at(start);
    if (old == kNoRegion || fresh[static_cast<std::size_t>(start)] != kNoRegion) return;
    fresh[static_cast<std::size_t>(start)] = regions.count;
    queue.assign(1, start);
    while (!queue.empty()) {
      const CellIndex cell = queue.back();
      queue.pop_back();
      for (const CellIndex near : beside(cell, space)) {
        if (regions.at(near) != old || fresh[static_cast<std::size_t>(near)] != kNoRegion) continue;
        fresh[static_cast<std::size_t>(near)] = regions.count;
        queue.push_back(near);
      }
    }
    ++regions.count;
  });
  regions.of_cell = std::move(fresh);
}

void fold_small(Regions& regions, const FreeSpace& space,
                const std::vector<std::int32_t>& clearance2, double least_m2,
                const Islets& islets) {
  const auto count = static_cast<std::size_t>(regions.count);
  std::vector<std::size_t> cells = cells_of_each(regions);
  std::vector<std::int32_t> peak2(count);
  // Of each pair of neighbours: the widest pass, and how many cells of it touch.
  struct Pass {
    std::int32_t clearance2 = 0;
    std::size_t cells = 0;
    bool operator<(const Pass& other) const noexcept {
      return std::pair(clearance2, cells) < std::pair(other.clearance2, other.cells);
    }
  };
  std::vector<std::map<Region, Pass>> passes(count);
  for_each_inner(space, [&](CellIndex cell) {
    const Region a = regions.at(cell);
    if (a == kNoRegion) return;
    const std::int32_t width = clearance2[static_cast<std::size_t>(cell)];
    peak2[static_cast<std::size_t>(a)] = std::max(peak2[static_cast<std::size_t>(a)], width);
    for (const CellIndex near : {cell + 1, cell + space.columns}) {
      const Region b = regions.at(near);
      if (b == kNoRegion || b == a) continue;
      const std::int32_t pass = std::min(width, clearance2[static_cast<std::size_t>(near)]);
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        Pass& known = passes[static_cast<std::size_t>(from)][to];
        known.clearance2 = std::max(known.clearance2, pass);
        ++known.cells;
      }
    }
  });

  std::vector<Region> becomes(count);
  std::set<std::pair<std::size_t, Region>> small;
  const auto note = [&](Region region) {
    const std::size_t size = cells[static_cast<std::size_t>(region)];
    if (space.area_m2(size) < least_m2) small.emplace(size, region);
  };
  for (Region region = 0; region < regions.count; ++region) {
    becomes[static_cast<std::size_t>(region)] = region;
    note(region);
    const double width_cells = islets.least_width_m / space.cell_m / 2;
    if (passes[static_cast<std::size_t>(region)].empty() &&
        (space.area_m2(cells[static_cast<std::size_t>(region)]) < islets.least_m2 ||
         peak2[static_cast<std::size_t>(region)] < width_cells * width_cells)) {
      becomes[static_cast<std::size_t>(region)] = kNoRegion;
    }
  }
  while (!small.empty()) {
    const auto [size, region] = *small.begin();
    small.erase(small.begin());
    auto& mine = passes[static_cast<std::size_t>(region)];
    if (mine.empty()) {
      becomes[static_cast<std::size_t>(region)] = kNoRegion;
      continue;
    }
    auto widest = mine.begin();
    for (auto it = mine.begin(); it != mine.end(); ++it) {
      if (widest->second < it->second) widest = it;
    }
    const Region host = widest->first;
    small.erase({cells[static_cast<std::size_t>(host)], host});
    becomes[static_cast<std::size_t>(region)] = host;
    cells[static_cast<std::size_t>(host)] += size;
    auto& theirs = passes[static_cast<std::size_t>(host)];
    theirs.erase(region);
    for (const auto& [other, pass] : mine) {
      if (other == host) continue;
      auto& back = passes[static_cast<std::size_t>(other)];
      back.erase(region);
      for (Pass* known : {&theirs[other], &back[host]}) {
        known->clearance2 = std::max(known->clearance2, pass.clearance2);
        known->cells += pass.cells;
      }
    }
    mine.clear();
    note(host);
  }
  const auto resolve = [&](Region region) {
    while (region != kNoRegion && becomes[static_cast<std::size_t>(region)] != region) {
      region = becomes[static_cast<std::size_t>(region)];
    }
    return region;
  };
  for (Region& region : regions.of_cell) region = resolve(region);
  renumber(regions, space);
}

void fill_gaps(Regions& regions, const FreeSpace& space, double most_m2) {
  std::vector<std::uint8_t> seen(space.size());
  std::vector<CellIndex> gap;
  for (std::int32_t y = 0; y < space.rows; ++y) {
    for (std::int32_t x = 0; x < space.columns; ++x) {
      const CellIndex start = space.at(x, y);
      if (regions.at(start) != kNoRegion || seen[static_cast<std::size_t>(start)] != 0) continue;
      gap.assign(1, start);
      seen[static_cast<std::size_t>(start)] = 1;
      Region around = kNoRegion;
      bool fit = true;
      for (std::size_t next = 0; next < gap.size(); ++next) {
        const std::int32_t cx = gap[next] % space.columns, cy = gap[next] / space.columns;
        for (std::int32_t v = cy - 1; v <= cy + 1; ++v) {
          for (std::int32_t u = cx - 1; u <= cx + 1; ++u) {
            if (u < 0 || v < 0 || u >= space.columns || v >= space.rows) {
              fit = false;
              continue;
            }
            const CellIndex near = space.at(u, v);
            const Region region = regions.at(near);
            if (region == kNoRegion) {
              if (seen[static_cast<std::size_t>(near)] != 0) continue;
              seen[static_cast<std::size_t>(near)] = 1;
              gap.push_back(near);
            } else if (around == kNoRegion || around == region) {
              around = region;
            } else {
              fit = false;
            }
          }
        }
      }
      if (!fit || around == kNoRegion || space.area_m2(gap.size()) >= most_m2) continue;
      for (const CellIndex cell : gap) regions.at(cell) = around;
    }
  }
}

void open_corners(Regions& regions, const FreeSpace& space) {
  // Every change can make a new corner next to it, never endlessly; the bound is for safety only.
  for (int pass = 0; pass < 64; ++pass) {
    bool changed = false;
    for (std::int32_t y = 0; y + 1 < space.rows; ++y) {
      for (std::int32_t x = 0; x + 1 < space.columns; ++x) {
        const CellIndex low_left = space.at(x, y), low_right = low_left + 1;
        const CellIndex high_left = low_left + space.columns, high_right = high_left + 1;
        for (const auto& [a, b, c, d] : {std::array{low_left, high_right, low_right, high_left},
                                         std::array{low_right, high_left, low_left, high_right}}) {
          const Region region = regions.at(a);
          if (region == kNoRegion || regions.at(b) != region) continue;
          if (regions.at(c) == region || regions.at(d) == region) continue;
          // A cell of a wall joins; between regions, the upper cell changes sides.
          const auto inner = [&](CellIndex cell) {
            const std::int32_t u = cell % space.columns, v = cell / space.columns;
            return u > 0 && v > 0 && u + 1 < space.columns && v + 1 < space.rows;
          };
          if (regions.at(c) == kNoRegion && inner(c)) {
            regions.at(c) = region;
          } else if (regions.at(d) == kNoRegion && inner(d)) {
            regions.at(d) = region;
          } else {
            regions.at(std::max(a, b)) = regions.at(std::max(c, d));
          }
          changed = true;
        }
      }
    }
    if (!changed) return;
  }
}

}  // namespace zonepack::packer::suggest
