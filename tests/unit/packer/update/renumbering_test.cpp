// SPDX-License-Identifier: Apache-2.0
#include "packer/update/renumbering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace zonepack::packer {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

Transform pose_at(float x) { return {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}; }

using Signature = HeldSignatures::Signature;

// As RTAB-Map has them: odometry at x = id, stamp = id seconds after `start`.
NodeOutline seen(std::int32_t id, std::int32_t session, double start) {
  NodeOutline out;
  out.id = id;
  out.map_id = session;
  out.stamp = start + id;
  out.pose = out.odometry_pose = pose_at(static_cast<float>(id));
  return out;
}

Signature held_as(const NodeOutline& node, std::vector<std::int32_t> links = {}) {
  Signature out;
  out.zone = 0;
  out.session = node.map_id;
  out.stamp = node.stamp;
  out.identity = identity_of(node.stamp, node.label, node.odometry_pose, node.pose);
  out.links = std::move(links);
  return out;
}

MapOutline outline_of(std::vector<NodeOutline> nodes) {
  MapOutline out;
  out.nodes = std::move(nodes);
  return out;
}

TEST(Renumbering, LeavesADatabaseThatWasGrownOnAsItIs) {
  const HeldSignatures map({{1, held_as(seen(1, 0, 100))}, {2, held_as(seen(2, 0, 100))}});
  const MapOutline grown = outline_of({seen(1, 0, 100), seen(2, 0, 100), seen(3, 1, 100)});
  const Renumbering numbers(map, grown);
  EXPECT_TRUE(numbers.grown());
  EXPECT_EQ(numbers.shared(), 2u);
  EXPECT_TRUE(numbers.shares(grown.nodes[1]));
  EXPECT_FALSE(numbers.shares(grown.nodes[2]));
  EXPECT_THAT(numbers.ids(), IsEmpty());
  EXPECT_THAT(numbers.sessions(), IsEmpty());
  EXPECT_EQ(numbers.in_database(2), 2);
  EXPECT_EQ(numbers.in_database(3), std::nullopt);
}

TEST(Renumbering, MovesAllIdsThatClashByOneOffset) {
  // The last id of both is 9, so 2 becomes 11 and 4 becomes 13; 9 is free and stays.
  const HeldSignatures map({{2, held_as(seen(2, 0, 100))}, {4, held_as(seen(4, 0, 100))}});
  const Renumbering numbers(map, outline_of({seen(2, 0, 900), seen(4, 0, 900), seen(9, 0, 900)}));
  EXPECT_FALSE(numbers.grown());
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(2, 11), Pair(4, 13)));
  EXPECT_THAT(numbers.sessions(), ElementsAre(Pair(0, 1))) << "the map has another session 0";
}

TEST(Renumbering, FindsAgainWhatAnEarlierUpdateRenumbered) {
  NodeOutline other = seen(2, 0, 900);
  Signature mapped = held_as(other);
  mapped.session = 1;
  const HeldSignatures map(
      {{2, held_as(seen(2, 0, 100))}, {4, held_as(seen(4, 0, 100))}, {6, std::move(mapped)}});
  const Renumbering numbers(map, outline_of({other, seen(4, 0, 900)}));
  EXPECT_EQ(numbers.shared(), 1u);
  // 2 is 6 in the map, an offset of 4 that 4 gets too.
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(2, 6), Pair(4, 8)));
  EXPECT_THAT(numbers.sessions(), ElementsAre(Pair(0, 1)));
  EXPECT_EQ(numbers.in_database(6), 2);
}

TEST(Renumbering, MovesTheEndsOfLinksAgainWhenTheIdsThatClashedAreGone) {
  // As above, but the map no longer holds 2; a link from 8 to where 2 went, 6, is still there.
  NodeOutline other = seen(4, 0, 900);
  const HeldSignatures map({{4, held_as(seen(4, 0, 100))}, {8, held_as(other, {6})}});
  const Renumbering numbers(map, outline_of({seen(2, 0, 900), other}));
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(2, 6), Pair(4, 8)));
}

TEST(Renumbering, IsNotFooledByAFewEqualStamps) {
  // Videos at one rate: of three ids that both have, one has the same stamp by chance.
  const HeldSignatures map(
      {{1, held_as(seen(1, 0, 0))}, {2, held_as(seen(2, 0, 0))}, {3, held_as(seen(3, 0, 0))}});
  NodeOutline chance = seen(1, 0, 0), second = seen(2, 0, 7), third = seen(3, 0, 9);
  chance.odometry_pose = pose_at(77);
  const Renumbering numbers(map, outline_of({chance, second, third}));
  EXPECT_FALSE(numbers.grown());
  EXPECT_EQ(numbers.shared(), 0u);
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(1, 4), Pair(2, 5), Pair(3, 6)));
}

TEST(Renumbering, KnowsFilesOfTilesByTheirNamesWhateverTheirNumbers) {
  const auto tile = [](std::int32_t id, const char* file) {
    NodeOutline out;
    out.id = id;
    out.label = file;
    out.pose = pose_at(static_cast<float>(id));
    return out;
  };
  const HeldSignatures map({{1, held_as(tile(1, "a.pcd"))}, {2, held_as(tile(2, "c.pcd"))}});
  MapOutline folder = outline_of({tile(1, "a.pcd"), tile(2, "b.pcd"), tile(3, "c.pcd")});
  folder.numbered_anew = true;
  const Renumbering numbers(map, folder);
  EXPECT_TRUE(numbers.grown());
  EXPECT_FALSE(numbers.shares(folder.nodes[1]));
  // c.pcd keeps the id that the map gave it; b.pcd, whose number is taken, gets one that neither
  // the map nor the folder has: 2 and their last id, 3.
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(2, 5), Pair(3, 2)));
}

TEST(Renumbering, KnowsTilesWithoutNamesByTheirPlace) {
  const auto tile = [](std::int32_t id, float x) {
    NodeOutline out;
    out.id = id;
    out.pose = pose_at(x);
    return out;
  };
  const HeldSignatures map({{1, held_as(tile(1, 10))}, {2, held_as(tile(2, 20))}});
  MapOutline cloud = outline_of({tile(1, 5), tile(2, 10), tile(3, 20)});
  cloud.numbered_anew = true;
  const Renumbering numbers(map, cloud);
  EXPECT_EQ(numbers.shared(), 2u);
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(1, 4), Pair(2, 1), Pair(3, 2)));  // 1 + 3
}

TEST(Renumbering, KeepsOffIdsThatLinksOfTheMapReferTo) {
  // 5 was left out when the map was packed, but a link leads to it: another database's 5 must not
  // become its end.
  const HeldSignatures map({{1, held_as(seen(1, 0, 100), {5, -3})}});
  const Renumbering numbers(map, outline_of({seen(5, 0, 900)}));
  // The last number that the map has or refers to is 5.
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(5, 10)));
}

TEST(Renumbering, GivesOtherIdsWhereTheOffsetLeadsTooFar) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  const HeldSignatures map({{kMost - 1, held_as(seen(kMost - 1, 0, 100))}});
  const Renumbering numbers(map, outline_of({seen(kMost - 1, 0, 900)}));
  EXPECT_THAT(numbers.ids(), ElementsAre(Pair(kMost - 1, kMost)));
  EXPECT_THROW(Renumbering(HeldSignatures({{kMost, held_as(seen(kMost, 0, 100))}}),
                           outline_of({seen(kMost, 0, 900)})),
               std::runtime_error);
}

TEST(Renumbering, RenumbersRecordsWithTheirLinks) {
  const HeldSignatures map({{2, held_as(seen(2, 0, 100))}});
  const Renumbering numbers(map, outline_of({seen(2, 0, 900), seen(3, 0, 900)}));
  SignatureRecord record;
  record.id = 3;
  record.map_id = 0;
  record.links.resize(3);
  record.links[0].to = 2;
  record.links[1].to = -7;  // a landmark: the same tag on the same wall
  record.links[2].to = 3;
  numbers.apply(record);
  EXPECT_EQ(record.id, 3);
  EXPECT_EQ(record.map_id, 1);
  std::vector<std::int32_t> ends;
  for (const Link& link : record.links) ends.push_back(link.to);
  EXPECT_THAT(ends, testing::UnorderedElementsAre(5, -7, 3));  // 2 and the last id of both, 3
}

}  // namespace
}  // namespace zonepack::packer
