// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace zonepack::packer::suggest {

std::vector<Kind> kinds_of(const Regions& regions, const FreeSpace& space,
                           const std::vector<std::int32_t>& clearance2) {
  const auto count = static_cast<std::size_t>(regions.count);
  const std::vector<std::size_t> cells = cells_of_each(regions);
  // The width of the median cell on the ridge would be better, but the mean clearance is as good:
  // across a strip of width w it is w / 4.
  std::vector<double> sum(count);
  std::vector<std::set<Region>> neighbours(count);
  for (std::int32_t y = 1; y + 1 < space.rows; ++y) {
    for (std::int32_t x = 1; x + 1 < space.columns; ++x) {
      const CellIndex cell = space.at(x, y);
      const Region region = regions.at(cell);
      if (region == kNoRegion) continue;
      sum[static_cast<std::size_t>(region)] += std::sqrt(clearance2[static_cast<std::size_t>(cell)]);
      for (const CellIndex near : {cell + 1, cell + space.columns}) {
        const Region other = regions.at(near);
        if (other == kNoRegion || other == region) continue;
        neighbours[static_cast<std::size_t>(region)].insert(other);
        neighbours[static_cast<std::size_t>(other)].insert(region);
      }
    }
  }
  std::vector<Kind> kinds(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double area = static_cast<double>(cells[i]);
    const double width = 4 * sum[i] / area;
    const double times_as_long = area / (width * width);
    kinds[i].area_m2 = space.area_m2(cells[i]);
    const std::size_t doors = neighbours[i].size();
    if ((times_as_long >= 4 && doors >= 2) || (times_as_long >= 2 && doors >= 5)) {
      kinds[i].name = "corridor";
    } else if (kinds[i].area_m2 >= 100) {
      kinds[i].name = "hall";
    } else if (kinds[i].area_m2 >= 30 && doors >= 3) {
      kinds[i].name = "lobby";
    } else if (kinds[i].area_m2 < 4) {
      kinds[i].name = "closet";
    }
  }
  return kinds;
}

std::vector<std::string> names_of(const std::vector<Kind>& kinds) {
  std::vector<std::size_t> order(kinds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return kinds[a].area_m2 > kinds[b].area_m2;
  });
  std::map<std::string, int> next;
  std::vector<std::string> names(kinds.size());
  for (const std::size_t i : order) {
    names[i] = std::string(kinds[i].name) + "-" + std::to_string(++next[kinds[i].name]);
  }
  return names;
}

}  // namespace zonepack::packer::suggest
