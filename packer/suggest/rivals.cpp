// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/rivals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace zonepack::packer::suggest {
namespace {

constexpr std::int32_t kStraight = 5, kDiagonal = 7;  // lengths of steps, in fifths of a cell

// The way on foot to every cell from the nearest of some, by Dijkstra; ties go to the earlier.
class Walk {
 public:
  explicit Walk(const FreeSpace& space) : space_(space), length_(space.size(), -1) {}

  // Calls reach(cell, from) whenever a cell is reached, in order of length; from is the cell
  // before, or the cell itself. Steps lead where may_enter(cell) allows, diagonal ones not past
  // corners.
  template <typename MayEnter, typename Reach>
  void run(std::span<const CellIndex> starts, MayEnter&& may_enter, Reach&& reach) {
    struct Step {
      std::int32_t length;
      std::int64_t order;
      CellIndex cell, from;
      bool operator>(const Step& other) const {
        return std::pair(length, order) > std::pair(other.length, other.order);
      }
    };
    std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
    std::int64_t order = 0;
    for (const CellIndex start : starts) queue.push({0, order++, start, start});
    while (!queue.empty()) {
      const Step step = queue.top();
      queue.pop();
      std::int32_t& length = length_[static_cast<std::size_t>(step.cell)];
      if (length >= 0) continue;
      length = step.length;
      reached_.push_back(step.cell);
      reach(step.cell, step.from);
      const auto go = [&](CellIndex to, std::int32_t more) {
        if (length_[static_cast<std::size_t>(to)] < 0 && may_enter(to)) {
          queue.push({step.length + more, order++, to, step.cell});
        }
      };
      const std::int32_t x = step.cell % space_.columns, y = step.cell / space_.columns;
      if (x == 0 || y == 0 || x + 1 == space_.columns || y + 1 == space_.rows) continue;
      const CellIndex c = step.cell, up = c + space_.columns, down = c - space_.columns;
      go(down, kStraight);
      go(c - 1, kStraight);
      go(c + 1, kStraight);
      go(up, kStraight);
      if (may_enter(down) && may_enter(c - 1)) go(down - 1, kDiagonal);
      if (may_enter(down) && may_enter(c + 1)) go(down + 1, kDiagonal);
      if (may_enter(up) && may_enter(c - 1)) go(up - 1, kDiagonal);
      if (may_enter(up) && may_enter(c + 1)) go(up + 1, kDiagonal);
    }
  }
  std::int32_t length(CellIndex cell) const { return length_[static_cast<std::size_t>(cell)]; }
  CellIndex last() const { return reached_.back(); }
  const std::vector<CellIndex>& reached() const { return reached_; }
  void forget() {
    for (const CellIndex cell : reached_) length_[static_cast<std::size_t>(cell)] = -1;
    reached_.clear();
  }

 private:
  const FreeSpace& space_;
  std::vector<std::int32_t> length_;  // fifths of a cell; -1: not reached
  std::vector<CellIndex> reached_;
};

}  // namespace

Regions squares_of(const FreeSpace& space, double side_m) {
  Regions regions;
  regions.of_cell.assign(space.size(), kNoRegion);
  const auto side = std::max<std::int32_t>(
      1, static_cast<std::int32_t>(std::min(side_m / space.cell_m + 0.5, 1e9)));
  const std::int32_t across = (space.columns - 1) / side + 1;
  std::vector<bool> has_free(static_cast<std::size_t>(across) *
                             static_cast<std::size_t>((space.rows - 1) / side + 1));
  const auto square = [&](std::int32_t x, std::int32_t y) {
    return (y - 1) / side * across + (x - 1) / side;
  };
  for (const bool mark : {true, false}) {
    for (std::int32_t y = 1; y + 1 < space.rows; ++y) {
      for (std::int32_t x = 1; x + 1 < space.columns; ++x) {
        const auto s = static_cast<std::size_t>(square(x, y));
        const CellIndex cell = space.at(x, y);
        if (mark) {
          if (space.is_free(cell)) has_free[s] = true;
        } else if (has_free[s]) {
          regions.at(cell) = static_cast<Region>(s);
        }
      }
    }
  }
  renumber(regions, space);
  return regions;
}

Regions stretches_of(const FreeSpace& space, std::span<const PathPlace> path) {
  Regions regions;
  regions.of_cell.assign(space.size(), kNoRegion);
  std::vector<CellIndex> starts;
  for (const PathPlace& place : path) {
    starts.push_back(place.cell);
    if (regions.at(place.cell) == kNoRegion) regions.at(place.cell) = place.stretch;
  }
  Walk walk(space);
  walk.run(
      starts, [&](CellIndex cell) { return space.is_free(cell); },
      [&](CellIndex cell, CellIndex from) { regions.at(cell) = regions.at(from); });
  renumber(regions, space);
  return regions;
}

void cut_long(Regions& regions, const FreeSpace& space, double most_m) {
  Walk walk(space);
  std::vector<bool> done(static_cast<std::size_t>(regions.count));
  Regions cut = regions;
  Region fresh = regions.count;
  const auto nothing = [](CellIndex, CellIndex) {};
  for (CellIndex cell = 0; static_cast<std::size_t>(cell) < space.size(); ++cell) {
    const Region region = regions.at(cell);
    if (region == kNoRegion || done[static_cast<std::size_t>(region)]) continue;
    done[static_cast<std::size_t>(region)] = true;
    const auto inside = [&](CellIndex c) { return regions.at(c) == region; };
    walk.run(std::array{cell}, inside, nothing);
    const CellIndex end = walk.last();
    walk.forget();
    walk.run(std::array{end}, inside, nothing);
    const std::int64_t length = walk.length(walk.last());
    const double length_m = static_cast<double>(length) / kStraight * space.cell_m;
    const auto parts = static_cast<std::int64_t>(std::ceil(length_m / most_m));
    if (parts > 1) {
      for (const CellIndex c : walk.reached()) {
        cut.at(c) = fresh + static_cast<Region>(walk.length(c) * parts / (length + 1));
      }
      fresh += static_cast<Region>(parts);
    }
    walk.forget();
  }
  renumber(cut, space);
  regions = std::move(cut);
}

}  // namespace zonepack::packer::suggest
