// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/islets.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace zonepack::packer::suggest {
namespace {

class IsletFolder {
 public:
  IsletFolder(Regions& regions, const FreeSpace& space)
      : regions_(regions), space_(space), seen_(space.size()), before_(space.size(), -1) {}

  void fold(CellIndex start, double reach_m) {
    std::vector<CellIndex> islet{start};
    seen_[static_cast<std::size_t>(start)] = 1;
    for (std::size_t next = 0; next < islet.size(); ++next) {
      for (const CellIndex near : beside(islet[next])) {
        if (!is_islet(near) || seen_[static_cast<std::size_t>(near)] != 0) continue;
        seen_[static_cast<std::size_t>(near)] = 1;
        islet.push_back(near);
      }
    }
    if (space_.area_m2(islet.size()) < kSpeck_m2) reach_m = std::min(reach_m, kSpeckReach_m);
    const CellIndex end = bridge(islet, static_cast<int>(reach_m / space_.cell_m + 0.5));
    if (end < 0) return;
    const Region home = regions_.at(end);
    for (CellIndex cell = before_[static_cast<std::size_t>(end)]; regions_.at(cell) == kNoRegion;
         cell = before_[static_cast<std::size_t>(cell)]) {
      regions_.at(cell) = home;
      if (before_[static_cast<std::size_t>(cell)] == cell) break;
    }
    for (const CellIndex cell : islet) regions_.at(cell) = home;
    forget();
  }

  bool is_islet(CellIndex cell) const {
    return space_.is_free(cell) && regions_.at(cell) == kNoRegion;
  }
  bool is_seen(CellIndex cell) const { return seen_[static_cast<std::size_t>(cell)] != 0; }

 private:
  std::array<CellIndex, 4> beside(CellIndex cell) const {
    return {cell - space_.columns, cell - 1, cell + 1, cell + space_.columns};
  }
  bool is_inner(CellIndex cell) const {
    const std::int32_t x = cell % space_.columns, y = cell / space_.columns;
    return x > 0 && y > 0 && x + 1 < space_.columns && y + 1 < space_.rows;
  }

  // The first cell of a region that rings around the islet meet, at most `reach` cells away; -1:
  // none. before_ leads back to the islet.
  CellIndex bridge(const std::vector<CellIndex>& islet, int reach) {
    touched_ = islet;
    for (const CellIndex cell : islet) before_[static_cast<std::size_t>(cell)] = cell;
    std::size_t from = 0;
    for (int ring = 0; ring <= reach; ++ring) {
      const std::size_t to = touched_.size();
      for (; from < to; ++from) {
        const CellIndex cell = touched_[from];
        for (const CellIndex near : beside(cell)) {
          if (before_[static_cast<std::size_t>(near)] >= 0 || !is_inner(near)) continue;
          before_[static_cast<std::size_t>(near)] = cell;
          touched_.push_back(near);
          if (regions_.at(near) != kNoRegion) return near;
        }
      }
    }
    forget();
    return -1;
  }
  void forget() {
    for (const CellIndex cell : touched_) before_[static_cast<std::size_t>(cell)] = -1;
    touched_.clear();
  }

  Regions& regions_;
  const FreeSpace& space_;
  std::vector<std::uint8_t> seen_;
  std::vector<CellIndex> before_;   // on the way from the islet; -1: not reached
  std::vector<CellIndex> touched_;  // by the search
};

}  // namespace

void fold_islets(Regions& regions, const FreeSpace& space, double reach_m) {
  IsletFolder folder(regions, space);
  for (std::size_t i = 0; i < space.size(); ++i) {
    const auto cell = static_cast<CellIndex>(i);
    if (folder.is_islet(cell) && !folder.is_seen(cell)) folder.fold(cell, reach_m);
  }
}

}  // namespace zonepack::packer::suggest
