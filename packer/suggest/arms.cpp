// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/arms.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace zonepack::packer::suggest {
namespace {

constexpr double kWideShare = 0.55;  // of the peak: narrower ground is an arm
constexpr double kArmShare = 0.5;
constexpr double kTimesAsLong = 4;
constexpr double kLeastHall_m2 = 15;

// One region in a grid of its own.
class ArmCutter {
 public:
  ArmCutter(Region region, const std::vector<CellIndex>& cells, const FreeSpace& space,
            const std::vector<std::int32_t>& clearance2)
      : region_(region), cells_(cells), space_(space), clearance2_(clearance2) {}

  // Gives the cells of each arm a number from `fresh` on; returns the next free number.
  Region cut(Regions& regions, Region fresh) {
    std::int32_t peak2 = 0;
    for (const CellIndex cell : cells_) {
      peak2 = std::max(peak2, clearance2_[static_cast<std::size_t>(cell)]);
    }
    // Squares: (0.55 r)^2, rounded down.
    const auto wide2 = static_cast<std::int32_t>(kWideShare * kWideShare * peak2);
    find_wide(wide2);
    std::size_t wide = 0;
    for (const CellIndex cell : cells_) wide += is_wide(cell) ? 1u : 0u;
    if (space_.area_m2(wide) < kLeastHall_m2) return fresh;
    for (const CellIndex start : cells_) {
      if (is_wide(start) || regions.at(start) != region_) continue;
      fresh = cut_from(start, peak2, regions, fresh);
    }
    return fresh;
  }

 private:
  std::size_t local(CellIndex cell) const {
    const std::int32_t x = cell % space_.columns - x0_, y = cell / space_.columns - y0_;
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(box_.columns) +
           static_cast<std::size_t>(x);
  }
  bool is_wide(CellIndex cell) const { return wide_[local(cell)] != 0; }

  // The region's opening by discs of the wide radius: every cell within that radius of a cell that
  // has this clearance.
  void find_wide(std::int32_t wide2) {
    x0_ = space_.columns;
    y0_ = space_.rows;
    std::int32_t x1 = 0, y1 = 0;
    for (const CellIndex cell : cells_) {
      const std::int32_t x = cell % space_.columns, y = cell / space_.columns;
      x0_ = std::min(x0_, x);
      y0_ = std::min(y0_, y);
      x1 = std::max(x1, x);
      y1 = std::max(y1, y);
    }
    box_.columns = x1 - x0_ + 1;
    box_.rows = y1 - y0_ + 1;
    box_.cell_m = space_.cell_m;
    box_.free.assign(static_cast<std::size_t>(box_.columns) * static_cast<std::size_t>(box_.rows),
                     1);
    for (const CellIndex cell : cells_) {
      if (clearance2_[static_cast<std::size_t>(cell)] >= wide2) box_.free[local(cell)] = 0;
    }
    const std::vector<std::int32_t> distance2 = squared_clearance(box_);
    wide_.resize(distance2.size());
    for (std::size_t i = 0; i < wide_.size(); ++i) wide_[i] = distance2[i] <= wide2 ? 1 : 0;
  }

  Region cut_from(CellIndex start, std::int32_t peak2, Regions& regions, Region fresh) {
    std::vector<CellIndex> arm{start};
    regions.at(start) = fresh;
    std::int32_t arm2 = 0;
    double sum = 0;
    for (std::size_t next = 0; next < arm.size(); ++next) {
      const CellIndex cell = arm[next];
      const std::int32_t width2 = clearance2_[static_cast<std::size_t>(cell)];
      arm2 = std::max(arm2, width2);
      sum += std::sqrt(width2);
      for (const CellIndex near :
           {cell - space_.columns, cell - 1, cell + 1, cell + space_.columns}) {
        if (regions.at(near) != region_ || is_wide(near)) continue;
        regions.at(near) = fresh;
        arm.push_back(near);
      }
    }
    const auto area = static_cast<double>(arm.size());
    const double width = 4 * sum / area;  // the mean clearance of a strip is a quarter of its width
    // Where it meets the hall, an arm is wider than elsewhere; its mean width counts.
    const bool narrow = width * width / 4 <= kArmShare * kArmShare * peak2;
    if (narrow && area >= kTimesAsLong * width * width && space_.area_m2(arm.size()) >= 4) {
      return fresh + 1;
    }
    for (const CellIndex cell : arm) regions.at(cell) = kKept;
    kept_.insert(kept_.end(), arm.begin(), arm.end());
    return fresh;
  }

 public:
  void restore(Regions& regions) const {
    for (const CellIndex cell : kept_) regions.at(cell) = region_;
  }

 private:
  static constexpr Region kKept = -2;
  const Region region_;
  const std::vector<CellIndex>& cells_;
  const FreeSpace& space_;
  const std::vector<std::int32_t>& clearance2_;
  std::int32_t x0_ = 0, y0_ = 0;
  FreeSpace box_;
  std::vector<std::uint8_t> wide_;
  std::vector<CellIndex> kept_;
};

}  // namespace

void cut_arms(Regions& regions, const FreeSpace& space,
              const std::vector<std::int32_t>& clearance2) {
  std::vector<std::vector<CellIndex>> cells(static_cast<std::size_t>(regions.count));
  for (std::size_t i = 0; i < space.size(); ++i) {
    if (regions.of_cell[i] != kNoRegion) {
      cells[static_cast<std::size_t>(regions.of_cell[i])].push_back(static_cast<CellIndex>(i));
    }
  }
  Region fresh = regions.count;
  for (Region region = 0; region < static_cast<Region>(cells.size()); ++region) {
    const auto& mine = cells[static_cast<std::size_t>(region)];
    if (space.area_m2(mine.size()) < kLeastHall_m2) continue;
    ArmCutter cutter(region, mine, space, clearance2);
    fresh = cutter.cut(regions, fresh);
    cutter.restore(regions);
  }
  renumber(regions, space);
}

}  // namespace zonepack::packer::suggest
