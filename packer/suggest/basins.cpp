// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/basins.hpp"

#include <algorithm>
#include <numeric>

namespace zonepack::packer::suggest {
namespace {

// Union-find over basins; the root is the basin with the highest peak, then the earlier one.
class Basins {
 public:
  Region add(std::int32_t peak2) {
    parent_.push_back(static_cast<Region>(parent_.size()));
    peak2_.push_back(peak2);
    return parent_.back();
  }
  Region root(Region basin) {
    auto& parent = parent_[static_cast<std::size_t>(basin)];
    while (parent_[static_cast<std::size_t>(basin)] != basin) {
      basin = parent_[static_cast<std::size_t>(basin)] =
          parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(basin)])];
    }
    return parent = basin;
  }
  std::int32_t peak2(Region root) const { return peak2_[static_cast<std::size_t>(root)]; }
  // Basins are added by falling peaks, so the earlier has the higher one.
  void join(Region a, Region b) {
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<Region> parent_;
  std::vector<std::int32_t> peak2_;
};

std::vector<CellIndex> by_falling_clearance(const std::vector<std::int32_t>& clearance2) {
  const std::int32_t most = *std::max_element(clearance2.begin(), clearance2.end());
  std::vector<std::size_t> start(static_cast<std::size_t>(most) + 2);
  for (const std::int32_t c : clearance2) ++start[static_cast<std::size_t>(most - c) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  const std::size_t free = start[static_cast<std::size_t>(most)];  // those with clearance
  std::vector<CellIndex> order(free);
  for (std::size_t i = 0; i < clearance2.size(); ++i) {
    if (clearance2[i] == 0) continue;
    order[start[static_cast<std::size_t>(most - clearance2[i])]++] = static_cast<CellIndex>(i);
  }
  return order;
}

}  // namespace

Regions basins_of(const FreeSpace& space, const std::vector<std::int32_t>& clearance2,
                  double door_ratio) {
  Regions regions;
  regions.of_cell.assign(space.size(), kNoRegion);
  Basins basins;
  const auto permille = static_cast<std::int64_t>(door_ratio * 1000 + 0.5);
  for (const CellIndex cell : by_falling_clearance(clearance2)) {
    const std::int64_t pass2 = clearance2[static_cast<std::size_t>(cell)];
    Region home = kNoRegion;
    std::int32_t home2 = -1;
    for (const CellIndex near : {cell - space.columns, cell - 1, cell + 1, cell + space.columns}) {
      const Region region = regions.at(near);
      const std::int32_t near2 = clearance2[static_cast<std::size_t>(near)];
      if (region == kNoRegion || near2 <= home2) continue;
      home = region;
      home2 = near2;
    }
    if (home == kNoRegion) {
      regions.at(cell) = basins.add(static_cast<std::int32_t>(pass2));
      continue;
    }
    regions.at(cell) = home;
    for (const CellIndex near : {cell - space.columns, cell - 1, cell + 1, cell + space.columns}) {
      if (regions.at(near) == kNoRegion) continue;
      const Region a = basins.root(home), b = basins.root(regions.at(near));
      if (a == b) continue;
      const std::int64_t narrower2 = std::min(basins.peak2(a), basins.peak2(b));
      if (pass2 * 1'000'000 >= permille * permille * narrower2) basins.join(a, b);
    }
  }
  for (Region& region : regions.of_cell) {
    if (region != kNoRegion) region = basins.root(region);
  }
  renumber(regions, space);
  return regions;
}

}  // namespace zonepack::packer::suggest
