// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/cracks.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace zonepack::packer::suggest {
namespace {

// The cells on both sides of the edge from a border's corner i to the next.
std::pair<CellIndex, CellIndex> beside(const Border& border, std::size_t i,
                                       const FreeSpace& space) {
  const Corner a = border.corners[i], b = border.corners[i + 1];
  const CellIndex cell = space.at(std::min(a.x, b.x), std::min(a.y, b.y));
  return {cell, a.x == b.x ? cell - 1 : cell - space.columns};
}

// Two regions that touch: how wide at most, squared in cells, and where.
struct Touch {
  Region a = kNoRegion, b = kNoRegion;
  std::int64_t width2 = 0;
  std::vector<std::pair<const Border*, Opening>> places;
};

std::vector<Touch> touches_of(const std::vector<Border>& borders, const FreeSpace& space) {
  std::map<std::pair<Region, Region>, Touch> found;
  for (const Border& border : borders) {
    if (!border.between_regions()) continue;
    const auto [a, b] = std::minmax(border.left, border.right);
    for (const Opening& opening : openings_of(border, space)) {
      Touch& touch = found[{a, b}];
      touch.a = a;
      touch.b = b;
      touch.width2 = std::max(touch.width2, width2_of(opening, border).value_or(INT64_MAX));
      touch.places.emplace_back(&border, opening);
    }
  }
  std::vector<Touch> touches;
  touches.reserve(found.size());
  for (auto& [pair, touch] : found) touches.push_back(std::move(touch));
  std::stable_sort(touches.begin(), touches.end(),
                   [](const Touch& s, const Touch& t) { return s.width2 > t.width2; });
  return touches;
}

class Groups {
 public:
  explicit Groups(std::int32_t count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  // Whether they were in two groups until now.
  bool join(Region a, Region b) {
    a = root(a);
    b = root(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    return a != b;
  }

 private:
  Region root(Region region) const {
    while (parent_[static_cast<std::size_t>(region)] != region) {
      region = parent_[static_cast<std::size_t>(region)];
    }
    return region;
  }
  std::vector<Region> parent_;
};

}  // namespace

std::vector<Opening> openings_of(const Border& border, const FreeSpace& space) {
  const auto is_open = [&](std::size_t i) {
    const auto [cell, other] = beside(border, i, space);
    return space.is_free(cell) && space.is_free(other);
  };
  std::vector<Opening> openings;
  for (std::size_t from = 0; from + 1 < border.corners.size();) {
    if (!is_open(from)) {
      ++from;
      continue;
    }
    std::size_t to = from + 1;
    while (to + 1 < border.corners.size() && is_open(to)) ++to;
    openings.push_back({from, to});
    from = to;
  }
  return openings;
}

std::optional<std::int64_t> width2_of(const Opening& opening, const Border& border) {
  const Corner from = border.corners[opening.from], to = border.corners[opening.to];
  if (from == to) return std::nullopt;
  return distance2(from, to);
}

bool part_at_cracks(Regions& regions, const FreeSpace& space, double least_m) {
  const std::vector<Border> borders = trace_borders(regions, space);
  const std::vector<std::size_t> cells = cells_of_each(regions);
  const double least = least_m / space.cell_m - 1e-9;
  Groups groups(regions.count);
  bool changed = false;
  for (const Touch& touch : touches_of(borders, space)) {
    const bool joins = groups.join(touch.a, touch.b);
    if (joins || static_cast<double>(touch.width2) >= least * least) continue;
    changed = true;
    const bool a_is_larger =
        cells[static_cast<std::size_t>(touch.a)] >= cells[static_cast<std::size_t>(touch.b)];
    const Region larger = a_is_larger ? touch.a : touch.b;
    for (const auto& [border, opening] : touch.places) {
      for (std::size_t i = opening.from; i < opening.to; ++i) {
        const auto [cell, other] = beside(*border, i, space);
        for (const CellIndex side : {cell, other}) {
          if (regions.at(side) == larger) regions.at(side) = kNoRegion;
        }
      }
    }
  }
  return changed;
}

}  // namespace zonepack::packer::suggest
