// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace zonepack {
namespace {

Box2 united(const Box2& a, const Box2& b) noexcept {
  return {{std::min(a.min.x_m, b.min.x_m), std::min(a.min.y_m, b.min.y_m)},
          {std::max(a.max.x_m, b.max.x_m), std::max(a.max.y_m, b.max.y_m)}};
}

}  // namespace

BoxTree::BoxTree(std::span<const Box2> boxes) : items_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.emplace_back();
  build(0, boxes, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::build(std::uint32_t node, std::span<const Box2> boxes, std::uint32_t begin,
                    std::uint32_t end) {
  Box2 box = boxes[items_[begin]];
  for (std::uint32_t i = begin + 1; i < end; ++i) box = united(box, boxes[items_[i]]);
  nodes_[node].box = box;
  if (end - begin <= kLeafItems) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  const bool along_x = box.max.x_m - box.min.x_m >= box.max.y_m - box.min.y_m;
  const auto twice_center = [&](std::uint32_t item) {
    const Box2& b = boxes[item];
    return along_x ? b.min.x_m + b.max.x_m : b.min.y_m + b.max.y_m;
  };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double ca = twice_center(a), cb = twice_center(b);
                     return ca != cb ? ca < cb : a < b;
                   });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_.emplace_back();
  nodes_[node].first = children;
  build(children, boxes, begin, middle);
  build(children + 1, boxes, middle, end);
}

bool BoxTree::near(const Box2& box, Point2 point, double radius_m) noexcept {
  const double dx = std::max({box.min.x_m - point.x_m, 0.0, point.x_m - box.max.x_m});
  const double dy = std::max({box.min.y_m - point.y_m, 0.0, point.y_m - box.max.y_m});
  return std::sqrt(dx * dx + dy * dy) <= radius_m;
}

ByteCount BoxTree::memory_bytes() const noexcept {
  return nodes_.capacity() * sizeof(Node) + items_.capacity() * sizeof(std::uint32_t);
}

}  // namespace zonepack
