// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/require.hpp"
#include "runtime/pack_format/file/geometry.hpp"

namespace zonepack {

// Finds the boxes near a point among a great many: a balanced tree of bounding boxes, split at the
// median of the longer side, so that its depth is log2 of the count however unevenly the boxes lie.
//
// Real-time: no allocation after construction; a visit costs O(log n) for each box it reports,
// unless most boxes overlap.
// Threads: immutable.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box2> boxes);

  // Calls fn(index) for every box within `radius_m` of the point, in no particular order.
  template <typename Fn>
  void visit_near(Point2 point, double radius_m, Fn&& fn) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kMaxDepth + 1> open;
    std::size_t depth = 0;
    open[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[open[--depth]];
      if (!near(node.box, point, radius_m)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) fn(items_[i]);
      } else {
        ZP_REQUIRE(depth + 2 <= open.size());
        open[depth++] = node.first;
        open[depth++] = node.first + 1;
      }
    }
  }

  ByteCount memory_bytes() const noexcept;

 private:
  static constexpr std::size_t kMaxDepth = 40;
  static constexpr std::uint32_t kLeafItems = 4;

  // A leaf holds items_[first, first + count); an inner node (count 0) the nodes first and first
  // + 1.
  struct Node {
    Box2 box;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  static bool near(const Box2& box, Point2 point, double radius_m) noexcept;
  void build(std::uint32_t node, std::span<const Box2> boxes, std::uint32_t begin,
             std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
};

}  // namespace zonepack
