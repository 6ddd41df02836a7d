// SPDX-License-Identifier: Apache-2.0
#include "packer/build/zone_edges.hpp"

#include <gtest/gtest.h>

namespace zonepack::packer {
namespace {

fb::Node node_of(std::int32_t id) { return {0, 0, 0, 0, id}; }

TEST(ZoneEdges, CountLinksBetweenZonesEitherWay) {
  ZoneEdges edges({{node_of(1), node_of(2)}, {node_of(3)}, {node_of(4)}});
  EXPECT_FALSE(edges.add(1, 2)) << "within a zone";
  EXPECT_FALSE(edges.add(1, 9)) << "to a signature that no zone holds";
  EXPECT_FALSE(edges.add(-5, 1)) << "from a landmark";
  EXPECT_EQ(edges.add(1, 3), std::pair(0U, 1U));
  EXPECT_EQ(edges.add(3, 1), std::pair(1U, 0U));
  EXPECT_EQ(edges.add(4, 2), std::pair(2U, 0U));
  const std::vector<fb::ZoneEdge> list = edges.list();
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].zone_a(), 0u);
  EXPECT_EQ(list[0].zone_b(), 1u);
  EXPECT_EQ(list[0].links(), 2u);
  EXPECT_EQ(list[1].zone_a(), 0u);
  EXPECT_EQ(list[1].zone_b(), 2u);
  EXPECT_EQ(list[1].links(), 1u);
}

}  // namespace
}  // namespace zonepack::packer
