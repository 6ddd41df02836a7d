// SPDX-License-Identifier: Apache-2.0
#include "packer/inspect/map_diff.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::SmallMap;
using Kind = ZoneDiff::Kind;

class MapDiffs : public testing::Test {
 protected:
  MapDiff diff() {
    return diff_maps(MapReader(on_disk(before_, "before")), MapReader(on_disk(after_, "after")));
  }

  std::filesystem::path on_disk(SmallMap& map, const char* name) {
    map.write_manifest();
    std::filesystem::create_directories(disk_ / name);
    for (const auto& [file, bytes] : map.folder.files) {
      test_support::write_bytes(disk_ / name / file, bytes);
    }
    return disk_ / name;
  }

  test_support::TemporaryFolder disk_;
  SmallMap before_, after_;
};

TEST_F(MapDiffs, OfOneVersionAreEmpty) {
  const MapDiff same = diff();
  EXPECT_TRUE(same.same_map);
  EXPECT_EQ(same.version_before, same.version_after);
  EXPECT_TRUE(same.zones.empty());
  EXPECT_EQ(same.unchanged, 2u);
  EXPECT_EQ(same.signatures_before, 2u);
  EXPECT_EQ(same.signatures_after, 2u);
  EXPECT_EQ(same.fetch_packs, 0u);
  EXPECT_EQ(same.fetch_manifest_bytes, 0u);
  EXPECT_FALSE(same.layers_changed);
}

TEST_F(MapDiffs, NameTheZoneWhosePackChangedAndWhatARobotFetches) {
  test_support::SignatureRecipe one, two, three;
  one.id = 1;
  one.x = 2;
  two.id = 2;
  two.x = 6;
  three.id = 3;
  three.x = 7;
  one.y = two.y = three.y = 2;
  before_ = SmallMap({one}, {two});
  after_ = SmallMap({one}, {two, three});
  const MapDiff grown = diff();
  ASSERT_EQ(grown.zones.size(), 1u);
  EXPECT_EQ(grown.zones[0].name, "b");
  EXPECT_EQ(grown.zones[0].kind, Kind::kChanged);
  EXPECT_EQ(grown.zones[0].signatures_before, 1u);
  EXPECT_EQ(grown.zones[0].signatures_after, 2u);
  EXPECT_EQ(grown.zones[0].pack, after_.packs[1].file);
  EXPECT_EQ(grown.unchanged, 1u);
  EXPECT_EQ(grown.fetch_packs, 1u);
  EXPECT_EQ(grown.fetch_pack_bytes, after_.packs[1].bytes);
  EXPECT_EQ(grown.fetch_manifest_bytes, after_.folder.files.at(std::string(kManifestName)).size());
  EXPECT_EQ(grown.pack_bytes_after, after_.packs[0].bytes + after_.packs[1].bytes);
}

TEST_F(MapDiffs, FetchNoPackForAnOutlineOrAText) {
  after_.plan.zones[0].polygon.outer[0] = {-1, 0};
  after_.plan.zones[1].layer = "rooms";
  const MapDiff drawn = diff();
  ASSERT_EQ(drawn.zones.size(), 2u);
  EXPECT_EQ(drawn.zones[0].kind, Kind::kRedrawn);
  EXPECT_EQ(drawn.zones[1].kind, Kind::kRedrawn);
  EXPECT_TRUE(drawn.zones[0].pack.empty());
  EXPECT_EQ(drawn.unchanged, 0u);
  EXPECT_EQ(drawn.fetch_packs, 0u);
  EXPECT_GT(drawn.fetch_manifest_bytes, 0u);
}

TEST_F(MapDiffs, CountAZoneThatIsGoneAndOneThatIsNew) {
  // The same pack under the same name: only a zone that is there twice, once in each, is unchanged.
  const auto without_b = [](SmallMap& map) {
    map.plan.zones.pop_back();
    map.plan.portals.clear();
    map.packs.pop_back();
    map.content.nodes.pop_back();
    map.content.edges.clear();
  };
  without_b(after_);
  const MapDiff less = diff();
  ASSERT_EQ(less.zones.size(), 1u);
  EXPECT_EQ(less.zones[0].kind, Kind::kRemoved);
  EXPECT_EQ(less.zones[0].signatures_before, 1u);
  EXPECT_EQ(less.zones[0].signatures_after, 0u);
  EXPECT_EQ(less.portals_removed, 1u);
  EXPECT_EQ(less.portals_added, 0u);
  EXPECT_EQ(less.fetch_packs, 0u);
  std::swap(before_, after_);
  const MapDiff more = diff();
  ASSERT_EQ(more.zones.size(), 1u);
  EXPECT_EQ(more.zones[0].kind, Kind::kAdded);
  EXPECT_EQ(more.zones[0].pack, after_.packs[1].file);
  EXPECT_EQ(more.portals_added, 1u);
}

TEST_F(MapDiffs, SeePortalsLayersAndAnotherLineage) {
  after_.plan.portals[0].segment.p.y_m = 1.0;
  after_.content.layers = {{"rooms", {{1, 5}}}};
  after_.content.lineage.fill(8);
  const MapDiff other = diff();
  EXPECT_EQ(other.portals_added, 1u);
  EXPECT_EQ(other.portals_removed, 1u);
  EXPECT_TRUE(other.layers_changed);
  EXPECT_FALSE(other.same_map);
  EXPECT_TRUE(other.zones.empty());
}

}  // namespace
}  // namespace zonepack::packer
