// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/doors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "packer/suggest/borders.hpp"

namespace zonepack::packer::suggest {
namespace {

class DoorStraightener {
 public:
  DoorStraightener(Regions& regions, const FreeSpace& space, double reach_m)
      : regions_(regions),
        space_(space),
        reach_(static_cast<std::size_t>(reach_m / space.cell_m + 0.5)) {}

  void run() {
    borders_ = trace_borders(regions_, space_);
    for (std::size_t i = 0; i < borders_.size(); ++i) {
      if (borders_[i].between_regions()) continue;
      for (const Corner end : {borders_[i].corners.front(), borders_[i].corners.back()}) {
        walls_[{end.x, end.y}].push_back(i);
      }
    }
    for (const Border& border : borders_) {
      if (border.between_regions() && border.corners.front() != border.corners.back()) {
        straighten(border);
      }
    }
  }

 private:
  // Corners of the walls on both sides of a border's end, the end first, then by rising distance.
  std::vector<Corner> ends_near(Corner end, const Border& border) const {
    std::vector<Corner> ends{end};
    const auto found = walls_.find({end.x, end.y});
    if (found == walls_.end()) return ends;
    for (const std::size_t i : found->second) {
      const Border& wall = borders_[i];
      const Region region = std::max(wall.left, wall.right);
      if (region != border.left && region != border.right) continue;
      const std::size_t most = std::min(reach_, wall.corners.size() - 1);
      for (std::size_t k = 1; k <= most; ++k) {
        const bool from_front = wall.corners.front() == end;
        ends.push_back(from_front ? wall.corners[k] : wall.corners[wall.corners.size() - 1 - k]);
      }
    }
    return ends;
  }

  bool is_of(CellIndex cell, const Border& border) const {
    const Region region = regions_.at(cell);
    return region == border.left || region == border.right;
  }

  // Whether the line runs inside the two regions: sampled every quarter cell, off its ends.
  bool is_clear(Corner p, Corner q, const Border& border) const {
    const auto steps =
        static_cast<std::int64_t>(4 * std::max(std::abs(p.x - q.x), std::abs(p.y - q.y)));
    for (std::int64_t k = 1; k < steps; ++k) {
      // In units of 1 / (2 * steps) cells; a sample on an edge looks at both cells.
      const std::int64_t x = p.x * steps + (q.x - p.x) * k, y = p.y * steps + (q.y - p.y) * k;
      const auto x0 = static_cast<std::int32_t>(x / steps),
                 y0 = static_cast<std::int32_t>(y / steps);
      const bool on_x = x % steps == 0, on_y = y % steps == 0;
      bool any = false;
      for (std::int32_t v = y0 - (on_y ? 1 : 0); v <= y0; ++v) {
        for (std::int32_t u = x0 - (on_x ? 1 : 0); u <= x0; ++u) {
          any = any || is_of(space_.at(u, v), border);
        }
      }
      if (!any) return false;
    }
    return true;
  }

  void straighten(const Border& border) {
    const Corner p0 = border.corners.front(), q0 = border.corners.back();
    std::vector<Corner> ps = ends_near(p0, border), qs = ends_near(q0, border);
    struct Line {
      std::int64_t length2, moved2;
      Corner p, q;
    };
    std::vector<Line> lines;
    for (const Corner p : ps) {
      for (const Corner q : qs) {
        if (p == q) continue;
        lines.push_back({distance2(p, q), distance2(p, p0) + distance2(q, q0), p, q});
      }
    }
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
      return std::pair(a.length2, a.moved2) < std::pair(b.length2, b.moved2);
    });
    int tried = 0;
    for (const Line& line : lines) {
      if (line.length2 > distance2(p0, q0)) break;
      if (!is_clear(line.p, line.q, border)) continue;
      if (move_border(border, line.p, line.q) || ++tried == 8) return;
    }
  }

  // Gives the cells between the border and the line to the region on whose side they are; false,
  // with nothing changed, when they do not end at the line and the walls.
  bool move_border(const Border& border, Corner p, Corner q) {
    std::int32_t x0 = std::min(p.x, q.x), x1 = std::max(p.x, q.x);
    std::int32_t y0 = std::min(p.y, q.y), y1 = std::max(p.y, q.y);
    for (const Corner c : border.corners) {
      x0 = std::min(x0, c.x);
      x1 = std::max(x1, c.x);
      y0 = std::min(y0, c.y);
      y1 = std::max(y1, c.y);
    }
    const auto margin = static_cast<std::int32_t>(reach_) + 1;
    x0 = std::max(x0 - margin, 0);
    y0 = std::max(y0 - margin, 0);
    x1 = std::min(x1 + margin, space_.columns) - 1;
    y1 = std::min(y1 + margin, space_.rows) - 1;
    const auto wrong = [&](CellIndex cell) {
      if (!is_of(cell, border)) return false;
      const Corner centre{2 * (cell % space_.columns) + 1, 2 * (cell / space_.columns) + 1};
      const std::int64_t s = side({2 * p.x, 2 * p.y}, {2 * q.x, 2 * q.y}, centre);
      if (s == 0) return false;
      return regions_.at(cell) != (s > 0 ? border.left : border.right);
    };
    // The cells on both sides of the border that are wrong, and all that these touch.
    std::vector<CellIndex> moved;
    std::map<CellIndex, bool> seen;
    const auto add = [&](std::int32_t x, std::int32_t y) {
      const CellIndex cell = space_.at(x, y);
      if (!wrong(cell) || !seen.emplace(cell, true).second) return;
      moved.push_back(cell);
    };
    for (const Corner c : border.corners) {
      for (std::int32_t v = c.y - 1; v <= c.y; ++v) {
        for (std::int32_t u = c.x - 1; u <= c.x; ++u) add(u, v);
      }
    }
    for (std::size_t next = 0; next < moved.size(); ++next) {
      const std::int32_t x = moved[next] % space_.columns, y = moved[next] / space_.columns;
      if (x <= x0 || y <= y0 || x >= x1 || y >= y1) return false;
      add(x - 1, y);
      add(x + 1, y);
      add(x, y - 1);
      add(x, y + 1);
    }
    for (const CellIndex cell : moved) {
      Region& region = regions_.at(cell);
      region = region == border.left ? border.right : border.left;
    }
    return true;
  }

  Regions& regions_;
  const FreeSpace& space_;
  const std::size_t reach_;
  std::vector<Border> borders_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> walls_;  // by end
};

}  // namespace

void straighten_doors(Regions& regions, const FreeSpace& space, double reach_m) {
  DoorStraightener(regions, space, reach_m).run();
}

}  // namespace zonepack::packer::suggest
