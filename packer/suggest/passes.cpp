// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/passes.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "packer/suggest/borders.hpp"

namespace zonepack::packer::suggest {
namespace {

constexpr double kAlongWall_m = 0.4;  // how far the outlines are followed from a door's end
constexpr double kThinWall_m = 0.45;  // how far apart they are there at most

class PassJudge {
 public:
  PassJudge(const Regions& regions, const FreeSpace& space,
            const std::vector<std::int32_t>& clearance2)
      : space_(space), clearance2_(clearance2), borders_(trace_borders(regions, space)) {
    for (const Border& border : borders_) {
      if (border.between_regions()) continue;
      walls_[{border.corners.front().x, border.corners.front().y}].push_back({&border, true});
      walls_[{border.corners.back().x, border.corners.back().y}].push_back({&border, false});
    }
  }

  struct Pass {
    std::int32_t clearance2 = 0;
    Region a = kNoRegion, b = kNoRegion;
    bool door = false;
  };

  // The widest pass of each pair of neighbours, widest first.
  std::vector<Pass> passes() const {
    std::map<std::pair<Region, Region>, Pass> widest;
    for (const Border& border : borders_) {
      if (!border.between_regions()) continue;
      const auto [a, b] = std::minmax(border.left, border.right);
      Pass& pass = widest[{a, b}];
      const std::int32_t width2 = widest_of(border);
      if (width2 < pass.clearance2) continue;
      pass = {width2, a, b, is_door(border)};
    }
    std::vector<Pass> list;
    list.reserve(widest.size());
    for (const auto& [pair, pass] : widest) list.push_back(pass);
    std::stable_sort(list.begin(), list.end(),
                     [](const Pass& a, const Pass& b) { return a.clearance2 > b.clearance2; });
    return list;
  }

 private:
  std::int32_t widest_of(const Border& border) const {
    std::int32_t most = 0;
    for (std::size_t i = 0; i + 1 < border.corners.size(); ++i) {
      const Corner a = border.corners[i], b = border.corners[i + 1];
      const CellIndex cell = space_.at(std::min(a.x, b.x), std::min(a.y, b.y));
      const CellIndex other = a.x == b.x ? cell - 1 : cell - space_.columns;
      most = std::max(most, std::min(clearance2_[static_cast<std::size_t>(cell)],
                                     clearance2_[static_cast<std::size_t>(other)]));
    }
    return most;
  }

  bool is_door(const Border& border) const {
    if (border.corners.front() == border.corners.back()) return false;
    return is_thin(border.corners.front(), border) || is_thin(border.corners.back(), border);
  }

  bool is_thin(Corner end, const Border& border) const {
    Corner of_left = end, of_right = end;
    bool left = false, right = false;
    const auto found = walls_.find({end.x, end.y});
    if (found == walls_.end()) return false;
    for (const auto& [wall, forwards] : found->second) {
      const Region region = std::max(wall->left, wall->right);
      if (region == border.left) {
        of_left = follow(*wall, forwards);
        left = true;
      } else if (region == border.right) {
        of_right = follow(*wall, forwards);
        right = true;
      }
    }
    const double cells = kThinWall_m / space_.cell_m;
    return left && right && static_cast<double>(distance2(of_left, of_right)) <= cells * cells;
  }

  // The corner of a wall that is kAlongWall_m from its beginning.
  Corner follow(const Border& wall, bool forwards) const {
    const double cells = kAlongWall_m / space_.cell_m;
    const std::size_t count = wall.corners.size();
    const auto at = [&](std::size_t i) { return wall.corners[forwards ? i : count - 1 - i]; };
    std::size_t i = 0;
    while (i + 1 < count && static_cast<double>(distance2(at(0), at(i))) < cells * cells) ++i;
    return at(i);
  }

  const FreeSpace& space_;
  const std::vector<std::int32_t>& clearance2_;
  const std::vector<Border> borders_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::pair<const Border*, bool>>>
      walls_;
};

}  // namespace

void join_without_door(Regions& regions, const FreeSpace& space,
                       const std::vector<std::int32_t>& clearance2, double loose_ratio) {
  std::vector<std::int32_t> peak2(static_cast<std::size_t>(regions.count));
  for (std::size_t i = 0; i < space.size(); ++i) {
    if (regions.of_cell[i] == kNoRegion) continue;
    std::int32_t& peak = peak2[static_cast<std::size_t>(regions.of_cell[i])];
    peak = std::max(peak, clearance2[i]);
  }
  std::vector<Region> joined(peak2.size());
  std::iota(joined.begin(), joined.end(), 0);
  const auto root = [&](Region region) {
    while (joined[static_cast<std::size_t>(region)] != region) {
      region = joined[static_cast<std::size_t>(region)];
    }
    return region;
  };
  const auto permille = static_cast<std::int64_t>(loose_ratio * 1000 + 0.5);
  for (const auto& pass : PassJudge(regions, space, clearance2).passes()) {
    const Region a = root(pass.a), b = root(pass.b);
    if (a == b || pass.door) continue;
    std::int32_t& peak_a = peak2[static_cast<std::size_t>(std::min(a, b))];
    const std::int32_t peak_b = peak2[static_cast<std::size_t>(std::max(a, b))];
    if (std::int64_t{pass.clearance2} * 1'000'000 <
        permille * permille * std::int64_t{std::min(peak_a, peak_b)}) {
      continue;
    }
    joined[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    peak_a = std::max(peak_a, peak_b);
  }
  for (Region& region : regions.of_cell) {
    if (region != kNoRegion) region = root(region);
  }
  renumber(regions, space);
}

}  // namespace zonepack::packer::suggest
