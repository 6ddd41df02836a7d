// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/suggest/free_space.hpp"
#include "packer/suggest/regions.hpp"

// Small grids drawn in letters, the top row first: '.' free, '#' not.
namespace zonepack::packer::suggest {

inline FreeSpace drawn_space(const std::vector<std::string>& rows, double cell_m = 0.5) {
  FreeSpace space;
  space.columns = static_cast<std::int32_t>(rows.front().size());
  space.rows = static_cast<std::int32_t>(rows.size());
  space.cell_m = cell_m;
  for (std::size_t row = rows.size(); row-- > 0;) {
    for (const char c : rows[row]) space.free.push_back(c == '#' ? 0 : 1);
  }
  return space;
}

// Letters of the regions, 'a' for 0; '#' for none.
inline std::vector<std::string> drawn(const Regions& regions, const FreeSpace& space) {
  std::vector<std::string> rows;
  for (std::int32_t y = space.rows; y-- > 0;) {
    rows.emplace_back();
    for (std::int32_t x = 0; x < space.columns; ++x) {
      const Region region = regions.at(space.at(x, y));
      rows.back() += region == kNoRegion ? '#' : static_cast<char>('a' + region);
    }
  }
  return rows;
}

inline Regions drawn_regions(const std::vector<std::string>& rows) {
  Regions regions;
  for (std::size_t row = rows.size(); row-- > 0;) {
    for (const char c : rows[row]) {
      regions.of_cell.push_back(c == '#' ? kNoRegion : c - 'a');
      if (c != '#') regions.count = std::max(regions.count, c - 'a' + 1);
    }
  }
  return regions;
}

}  // namespace zonepack::packer::suggest
