// SPDX-License-Identifier: Apache-2.0
#include "packer/inspect/map_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "packer/build/manifest_writer.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/run/maps/map_demand.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr PayloadMask kFeaturesOnly = kCoreOnly | mask_of(fb::PayloadKind::Features);
constexpr ZoneId kA = 0, kB = 1, kC = 2, kD = 3;
constexpr ByteCount kSlot = kSlotBytes + kTableBytesPerSlot;

// Four rooms in a row, A-B-C-D, that take 4, 3, 5 and 1 slots with their features, one without.
class RowOfRooms {
 public:
  RowOfRooms() {
    const std::uint32_t slots[] = {4, 3, 5, 1};
    ZonePlan plan;
    std::vector<PackSummary> packs;
    for (int i = 0; i < 4; ++i) {
      const double x = i;
      PlannedZone& zone = plan.zones.emplace_back();
      zone.name = std::string(1, static_cast<char>('A' + i));
      zone.polygon.outer = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
      PackSummary& pack = packs.emplace_back();
      pack.file = zone.name + ".zpk";
      pack.signatures = 10u * static_cast<std::uint32_t>(i + 1);
      pack.payloads[0] = {.decoded = 2000, .stored = 1000, .chunks = 1};
      pack.payloads[1] = {.decoded = 60000, .stored = 500u * slots[i], .chunks = slots[i]};
      pack.slots = {1, slots[i]};
      if (i > 0) {
        const auto zone_a = static_cast<std::uint32_t>(i - 1);
        plan.portals.push_back({.name = "p" + zone.name,
                                .zone_a = zone_a,
                                .zone_b = zone_a + 1,
                                .segment = {{x, 0.2}, {x, 0.8}}});
      }
    }
    ManifestContent content;
    content.plan = &plan;
    content.packs = &packs;
    for (const PackSummary& pack : packs) content.nodes.emplace_back(pack.signatures);
    content.payload = kFeaturesOnly;
    content.source_kind = "test";
    file_ = manifest_bytes(content);
  }
  const fb::Manifest& manifest() const { return **check_manifest(file_); }
  std::string_view text() const {
    return {reinterpret_cast<const char*>(file_.data()), file_.size()};
  }

 private:
  Bytes file_;
};

TEST(MapPlan, CountsSlotsAndStoredBytesOfThePayload) {
  const RowOfRooms map;
  const MapPlan with = plan_map(map.manifest(), kFeaturesOnly, {}, std::nullopt);
  ASSERT_EQ(with.zones.size(), 4u);
  EXPECT_EQ(with.zones[kC].name, "C");
  EXPECT_EQ(with.zones[kC].signatures, 30u);
  EXPECT_EQ(with.zones[kC].charged_bytes, 5 * kSlotBytes);
  EXPECT_EQ(with.zones[kC].stored_bytes, 1000u + 5 * 500u);
  const MapPlan without = plan_map(map.manifest(), kCoreOnly, {}, std::nullopt);
  EXPECT_EQ(without.zones[kC].charged_bytes, kSlotBytes);
  EXPECT_EQ(without.zones[kC].stored_bytes, 1000u);
}

TEST(MapPlan, TakesTheLargestPairOfNeighbours) {
  const RowOfRooms map;
  const MapPlan plan = plan_map(map.manifest(), kFeaturesOnly, {}, std::nullopt);
  // A-B 4 + 3, B-C 3 + 5, C-D 5 + 1. A and C, 9 slots, are no neighbours.
  EXPECT_EQ(plan.smallest.slots, 8u);
  EXPECT_EQ(plan.smallest.pair.zone_a, kB);
  EXPECT_EQ(plan.smallest.pair.zone_b, kC);
  EXPECT_EQ(plan.smallest.bytes, plan.fixed_bytes + 8 * kSlot);
  EXPECT_EQ(plan.live_change_bytes, plan.smallest.bytes + plan.fixed_bytes + 5 * kSlot);
}

TEST(MapPlan, HoldsPinnedZonesBesidesEveryPair) {
  const RowOfRooms map;
  const ZoneId pinned[] = {kB};
  const MapPlan plan = plan_map(map.manifest(), kFeaturesOnly, pinned, std::nullopt);
  // B is held: A-B needs 4 more, B-C 5, C-D 6.
  EXPECT_EQ(plan.smallest.slots, 3u + 6u);
  EXPECT_EQ(plan.smallest.pair.zone_a, kC);
  EXPECT_EQ(plan.smallest.pair.zone_b, kD);
  EXPECT_TRUE(plan.zones[kB].pinned);
  EXPECT_FALSE(plan.zones[kA].pinned);
}

// What plan promises is what the robot's own Residency keeps.
TEST(MapPlan, PromisesTheBudgetUnderWhichTheRobotPins) {
  const RowOfRooms map;
  const test_support::TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / std::string(kManifestName), map.text()).ok());
  const auto catalog = Catalog::open(folder.path().string(), kFeaturesOnly);
  ASSERT_TRUE(catalog.ok());
  for (const ZoneId zone : {kA, kB, kC, kD}) {
    const ZoneId pinned[] = {zone};
    const ByteCount smallest =
        plan_map(map.manifest(), kFeaturesOnly, pinned, std::nullopt).smallest.bytes;
    const ResidencyLimits limits = limits_for(*catalog, smallest, 0, {zone});
    Residency enough(catalog->zones.size(), limits);
    EXPECT_TRUE(enough.pin(zone, needs_of(*catalog)[zone]).ok()) << zone;
    Residency less(catalog->zones.size(), limits_for(*catalog, smallest - 1, 0, {zone}));
    EXPECT_FALSE(less.pin(zone, needs_of(*catalog)[zone]).ok()) << zone;
    EXPECT_EQ(limits_for(*catalog, std::nullopt, 0, {zone}).budget, smallest);
  }
}

TEST(MapPlan, SaysThatTheSmallestBudgetSufficesAndOneByteLessDoesNot) {
  const RowOfRooms map;
  const ByteCount smallest =
      plan_map(map.manifest(), kFeaturesOnly, {}, std::nullopt).smallest.bytes;
  const BudgetPlan enough = *plan_map(map.manifest(), kFeaturesOnly, {}, smallest).budget;
  EXPECT_TRUE(enough.suffices);
  EXPECT_EQ(enough.slots, 8u);
  EXPECT_THAT(enough.zones_without_room, IsEmpty());
  EXPECT_THAT(enough.pairs_without_room, IsEmpty());
  EXPECT_EQ(enough.largest_zones_at_once, 1u);  // C and A take 9
  EXPECT_FALSE(enough.whole_map);

  const BudgetPlan less = *plan_map(map.manifest(), kFeaturesOnly, {}, smallest - 1).budget;
  EXPECT_FALSE(less.suffices);
  EXPECT_EQ(less.slots, 7u);
  EXPECT_THAT(less.zones_without_room, IsEmpty());
  EXPECT_THAT(less.pairs_without_room, ElementsAre(ZonePair(kB, kC)));
}

TEST(MapPlan, NamesZonesWithoutRoomAndThenOnlyPairsThatWouldFitAlone) {
  const RowOfRooms map;
  const ByteCount fixed = plan_map(map.manifest(), kFeaturesOnly, {}, std::nullopt).fixed_bytes;
  const BudgetPlan plan = *plan_map(map.manifest(), kFeaturesOnly, {}, fixed + 4 * kSlot).budget;
  EXPECT_THAT(plan.zones_without_room, ElementsAre(kC));
  EXPECT_THAT(plan.pairs_without_room, ElementsAre(ZonePair(kA, kB)));
  EXPECT_EQ(plan.largest_zones_at_once, 0u);
}

TEST(MapPlan, KnowsWhenTheWholeMapFits) {
  const RowOfRooms map;
  const ByteCount fixed = plan_map(map.manifest(), kFeaturesOnly, {}, std::nullopt).fixed_bytes;
  const ZoneId pinned[] = {kD};
  const BudgetPlan all =
      *plan_map(map.manifest(), kFeaturesOnly, pinned, fixed + 13 * kSlot).budget;
  EXPECT_TRUE(all.whole_map);
  EXPECT_EQ(all.largest_zones_at_once, 4u);
  // With D held, 12 slots leave 11 for C, A and B, which take 12.
  const BudgetPlan most =
      *plan_map(map.manifest(), kFeaturesOnly, pinned, fixed + 12 * kSlot).budget;
  EXPECT_FALSE(most.whole_map);
  EXPECT_EQ(most.largest_zones_at_once, 3u);
}

TEST(MapPlan, FindsNoRoomInABudgetThatDoesNotPayForTheTables) {
  const RowOfRooms map;
  const ByteCount fixed = plan_map(map.manifest(), kFeaturesOnly, {}, std::nullopt).fixed_bytes;
  const BudgetPlan plan = *plan_map(map.manifest(), kFeaturesOnly, {}, fixed - 1).budget;
  EXPECT_FALSE(plan.suffices);
  EXPECT_EQ(plan.slots, 0u);
  EXPECT_EQ(plan.zones_without_room.size(), 4u);
}

}  // namespace
}  // namespace zonepack::packer
