// SPDX-License-Identifier: Apache-2.0
#include "packer/suggest/borders.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace zonepack::packer::suggest {
namespace {

// Directions: 0 right, 1 up, 2 left, 3 down.
constexpr std::array<std::int32_t, 4> kStepX{1, 0, -1, 0}, kStepY{0, 1, 0, -1};

class Tracer {
 public:
  Tracer(const Regions& regions, const FreeSpace& space)
      : regions_(regions), space_(space), walked_(corner_count()) {}

  std::vector<Border> run() {
    // From nodes first, then what is left: loops.
    for (const bool loops : {false, true}) {
      for (std::int32_t y = 0; y <= space_.rows; ++y) {
        for (std::int32_t x = 0; x <= space_.columns; ++x) {
          const Corner corner{x, y};
          if (!loops && !is_node(corner)) continue;
          for (int d = 0; d < 4; ++d) {
            if (is_border(corner, d) && !is_walked(corner, d)) walk(corner, d);
          }
        }
      }
    }
    return std::move(borders_);
  }

 private:
  std::size_t corner_count() const {
    return static_cast<std::size_t>(space_.columns + 1) * static_cast<std::size_t>(space_.rows + 1);
  }
  std::size_t index(Corner c) const {
    return static_cast<std::size_t>(c.y) * static_cast<std::size_t>(space_.columns + 1) +
           static_cast<std::size_t>(c.x);
  }
  Region region(std::int32_t x, std::int32_t y) const {
    if (x < 0 || y < 0 || x >= space_.columns || y >= space_.rows) return kNoRegion;
    return regions_.at(space_.at(x, y));
  }
  // Of the edge that leaves `c` in direction `d`.
  Region left_of(Corner c, int d) const {
    constexpr std::array<std::int32_t, 4> kX{0, -1, -1, 0}, kY{0, 0, -1, -1};
    return region(c.x + kX[static_cast<std::size_t>(d)], c.y + kY[static_cast<std::size_t>(d)]);
  }
  Region right_of(Corner c, int d) const { return left_of(c, (d + 3) % 4); }
  bool is_border(Corner c, int d) const { return left_of(c, d) != right_of(c, d); }
  bool is_node(Corner c) const {
    int edges = 0;
    for (int d = 0; d < 4; ++d) edges += is_border(c, d) ? 1 : 0;
    return edges > 2;
  }
  bool is_walked(Corner c, int d) const { return (walked_[index(c)] >> d & 1) != 0; }
  Corner step(Corner c, int d) {
    walked_[index(c)] = static_cast<std::uint8_t>(walked_[index(c)] | 1 << d);
    const Corner to{c.x + kStepX[static_cast<std::size_t>(d)],
                    c.y + kStepY[static_cast<std::size_t>(d)]};
    walked_[index(to)] = static_cast<std::uint8_t>(walked_[index(to)] | 1 << (d + 2) % 4);
    return to;
  }

  void walk(const Corner start, int d) {
    Border border{left_of(start, d), right_of(start, d), {start}};
    Corner at = start;
    do {
      at = step(at, d);
      border.corners.push_back(at);
      if (is_node(at)) break;
      for (const int turn : {3, 0, 1}) {
        const int next = (d + turn) % 4;
        if (is_border(at, next)) {
          d = next;
          break;
        }
      }
    } while (at != start);
    borders_.push_back(std::move(border));
  }

  const Regions& regions_;
  const FreeSpace& space_;
  std::vector<std::uint8_t> walked_;  // of each corner, a bit for each direction
  std::vector<Border> borders_;
};

// In half cells, as centres are.
Corner doubled(Corner c) { return {2 * c.x, 2 * c.y}; }

// The centres of the two cells on either side of the edge from `a` to `b`, in half cells: left,
// right.
std::pair<Corner, Corner> beside(Corner a, Corner b) {
  const std::int32_t dx = b.x - a.x, dy = b.y - a.y;
  const Corner middle{a.x + b.x, a.y + b.y};
  return {{middle.x - dy, middle.y + dx}, {middle.x + dy, middle.y - dx}};
}

// The directions a line from one corner may take so that all edges up to now keep their cells: a
// cone, between the line furthest to the right and the one furthest to the left that are allowed.
class Simplifier {
 public:
  explicit Simplifier(const Border& border) : border_(border) {
    least_ = border.between_regions() ? 0 : 1;
  }

  void add_from(std::size_t first, std::size_t last, std::vector<Corner>& out) {
    out.push_back(border_.corners[first]);
    for (std::size_t at = first; at < last;) {
      at = furthest(at, last);
      out.push_back(border_.corners[at]);
    }
  }

 private:
  bool fits(std::size_t i, std::size_t j) const {
    const Corner a = doubled(border_.corners[i]), b = doubled(border_.corners[j]);
    for (std::size_t k = i; k < j; ++k) {
      const auto [left, right] = beside(border_.corners[k], border_.corners[k + 1]);
      if (side(a, b, left) < least_ || side(a, b, right) > -least_) return false;
    }
    return true;
  }

  // A line that fits, from `i` to a corner as far along as can be found: the directions that keep
  // the cells form a cone, which only narrows.
  std::size_t furthest(std::size_t i, std::size_t last) const {
    const Corner a = doubled(border_.corners[i]);
    std::size_t best = i + 1;
    Corner low{}, high{};  // the cone: right of it lie right cells, left of it left ones
    for (std::size_t k = i; k < last; ++k) {
      const auto [left, right] = beside(border_.corners[k], border_.corners[k + 1]);
      if (k == i) {
        low = right;
        high = left;
      } else {
        if (side(a, low, right) > 0) low = right;
        if (side(a, high, left) < 0) high = left;
      }
      if (side(a, low, high) <= 0) break;
      const Corner b = doubled(border_.corners[k + 1]);
      if (side(a, low, b) >= 0 && side(a, high, b) <= 0 && fits(i, k + 1)) best = k + 1;
    }
    return best;
  }

  const Border& border_;
  std::int64_t least_ = 0;
};

}  // namespace

std::vector<Border> trace_borders(const Regions& regions, const FreeSpace& space) {
  return Tracer(regions, space).run();
}

Border simplified(const Border& border) {
  Border result{border.left, border.right, {}};
  Simplifier simplifier(border);
  const std::size_t last = border.corners.size() - 1;
  if (border.corners.front() != border.corners.back()) {
    simplifier.add_from(0, last, result.corners);
    return result;
  }
  // A loop is cut where it is furthest from its beginning, so that it stays a ring.
  const Corner first = border.corners.front();
  std::size_t far = 0;
  for (std::size_t i = 1; i < last; ++i) {
    if (distance2(first, border.corners[i]) > distance2(first, border.corners[far])) far = i;
  }
  simplifier.add_from(0, far, result.corners);
  result.corners.pop_back();
  simplifier.add_from(far, last, result.corners);
  return result;
}

std::vector<std::vector<std::vector<Corner>>> rings_of(const std::vector<Border>& borders,
                                                       std::int32_t regions) {
  // Directed: each border to the right of itself forwards, and to the left backwards.
  struct Way {
    const Border* border;
    bool forwards;
    Corner start() const { return forwards ? border->corners.front() : border->corners.back(); }
    Corner end() const { return forwards ? border->corners.back() : border->corners.front(); }
  };
  std::vector<std::vector<Way>> ways(static_cast<std::size_t>(regions));
  for (const Border& border : borders) {
    if (border.left != kNoRegion) {
      ways[static_cast<std::size_t>(border.left)].push_back({&border, true});
    }
    if (border.right != kNoRegion) {
      ways[static_cast<std::size_t>(border.right)].push_back({&border, false});
    }
  }
  const auto twice_area = [](const std::vector<Corner>& ring) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Corner a = ring[i], b = ring[(i + 1) % ring.size()];
      sum += std::int64_t{a.x} * b.y - std::int64_t{b.x} * a.y;
    }
    return sum;
  };
  std::vector<std::vector<std::vector<Corner>>> rings(ways.size());
  for (std::size_t region = 0; region < ways.size(); ++region) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> from;  // by the start's x and y
    for (std::size_t i = 0; i < ways[region].size(); ++i) {
      const Corner start = ways[region][i].start();
      from.emplace(std::pair{start.x, start.y}, i);
    }
    std::vector<bool> used(ways[region].size());
    for (std::size_t first = 0; first < used.size(); ++first) {
      if (used[first]) continue;
      std::vector<Corner> ring;
      for (std::size_t i = first; !used[i];) {
        used[i] = true;
        const Way& way = ways[region][i];
        std::vector<Corner> corners = way.border->corners;
        if (!way.forwards) std::reverse(corners.begin(), corners.end());
        ring.insert(ring.end(), corners.begin(), corners.end() - 1);
        const auto next = from.find({way.end().x, way.end().y});
        if (next == from.end()) break;
        i = next->second;
      }
      // The node between two borders may lie on a straight line; neighbours need it.
      if (twice_area(ring) > 0) {
        rings[region].insert(rings[region].begin(), std::move(ring));
      } else {
        rings[region].push_back(std::move(ring));
      }
    }
  }
  return rings;
}

}  // namespace zonepack::packer::suggest
