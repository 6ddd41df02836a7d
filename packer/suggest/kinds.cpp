// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/kinds.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace zonepack::packer::suggest {
namespace {

constexpr double kWidestCorridor_m = 5;

}  // namespace

std::vector<Kind> kinds_of(const Regions& regions, const FreeSpace& space,
                           const std::vector<std::int32_t>& clearance2) {
  const auto count = static_cast<std::size_t>(regions.count);
  const std::vector<std::size_t> cells = cells_of_each(regions);
  std::vector<std::int32_t> peak2(count);
  std::vector<std::set<Region>> neighbours(count);
  for (std::int32_t y = 1; y + 1 < space.rows; ++y) {
    for (std::int32_t x = 1; x + 1 < space.columns; ++x) {
      const CellIndex cell = space.at(x, y);
      const Region region = regions.at(cell);
      if (region == kNoRegion) continue;
      std::int32_t& peak = peak2[static_cast<std::size_t>(region)];
      peak = std::max(peak, clearance2[static_cast<std::size_t>(cell)]);
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
    kinds[i].area_m2 = space.area_m2(cells[i]);
    const double square = space.area_m2(1) * 4 * peak2[i];  // as wide as it is at its widest
    const double times_as_long = kinds[i].area_m2 / square;
    const std::size_t doors = neighbours[i].size();
    const bool long_enough =
        (times_as_long >= 4 && doors >= 2) || (times_as_long >= 3 && doors >= 5);
    if (long_enough && square <= kWidestCorridor_m * kWidestCorridor_m) {
      kinds[i].name = "corridor";
    } else if (kinds[i].area_m2 >= 30 && doors >= 3) {
      kinds[i].name = "lobby";
    } else if (kinds[i].area_m2 >= 100) {
      kinds[i].name = "hall";
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
