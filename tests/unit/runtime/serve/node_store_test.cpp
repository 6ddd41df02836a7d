// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/node_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <tuple>

#include "packer/build/manifest_writer.hpp"
#include "platform/files/atomic_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using Nodes = std::vector<std::vector<fb::Node>>;  // by zone

void write_map(const std::filesystem::path& folder, const Nodes& nodes) {
  packer::ZonePlan plan;
  std::vector<packer::PackSummary> packs;
  packer::ManifestContent content;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double x = 10.0 * static_cast<double>(i);
    packer::PlannedZone& zone = plan.zones.emplace_back();
    zone.name = "z" + std::to_string(100 + i);
    zone.polygon.outer = {{x, 0}, {x + 10, 0}, {x + 10, 10}, {x, 10}};
    packer::PackSummary& pack = packs.emplace_back();
    pack.file = zone.name + "-0123456789abcdef.zpk";
    pack.signatures = static_cast<std::uint32_t>(nodes[i].size());
    pack.slots = {1};
  }
  content.plan = &plan;
  content.packs = &packs;
  content.payload = kCoreOnly;
  content.nodes = nodes;
  const packer::Bytes bytes = packer::manifest_bytes(content);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  ASSERT_TRUE(write_file_atomically(folder / std::string(kManifestName), text).ok());
}

// `count` nodes at random places of the zone, some outside it, as orphans are.
std::vector<fb::Node> scattered(std::size_t zone, std::size_t count, std::mt19937& random) {
  std::vector<fb::Node> nodes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = [&] { return static_cast<float>(random() % 1200) / 100 - 1; };
    nodes.emplace_back(static_cast<float>(10 * zone) + place(), place(), 0.0f, 0.5f,
                       static_cast<std::int32_t>(1000 * zone + i));
  }
  return nodes;
}

class Store : public testing::Test {
 protected:
  test_support::TemporaryFolder folder;
  std::mt19937 random{5};

  Result<NodeStore> open() {
    const auto catalog = Catalog::open(folder.path().string(), kCoreOnly);
    EXPECT_TRUE(catalog.ok());
    return NodeStore::open(*catalog);
  }
};

TEST_F(Store, GivesTheNodesOfAZoneBlockByBlock) {
  const Nodes nodes = {scattered(0, 3, random), scattered(1, 1300, random), {}};
  write_map(folder.path(), nodes);
  auto store = open();
  ASSERT_TRUE(store.ok());
  EXPECT_EQ(store->count(1), 1300u);
  EXPECT_EQ(store->count(2), 0u);
  EXPECT_EQ(store->count(99), 0u);
  EXPECT_EQ(store->read(2, 0).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(store->read(1, 1300).error().code, ErrorCode::kNotFound);
  std::uint32_t first = 100;  // in the middle of the first block
  std::vector<std::int32_t> ids;
  while (first < 1300) {
    const auto part = store->read(1, first);
    ASSERT_TRUE(part.ok());
    EXPECT_LE(part->size(), NodeStore::kBlockNodes);
    for (const fb::Node& node : *part) ids.push_back(node.id());
    first += static_cast<std::uint32_t>(part->size());
  }
  ASSERT_EQ(ids.size(), 1200u);
  EXPECT_EQ(ids.front(), 1100);
  EXPECT_EQ(ids.back(), 2299);
}

TEST_F(Store, FindsWhatABruteSearchFinds) {
  Nodes nodes;
  for (std::size_t zone = 0; zone < 12; ++zone) nodes.push_back(scattered(zone, 700, random));
  write_map(folder.path(), nodes);
  auto store = open();
  ASSERT_TRUE(store.ok());
  const auto only_even = [](ZoneId zone) { return zone % 2 == 0; };
  for (int i = 0; i < 200; ++i) {
    const Point2 at{static_cast<double>(random() % 12'000) / 100, 5};
    const double radius = static_cast<double>(random() % 30);
    const std::size_t most = 1 + random() % 64;
    std::vector<std::tuple<double, ZoneId, std::int32_t>> expected;
    for (ZoneId zone = 0; zone < nodes.size(); zone += 2) {
      for (const fb::Node& node : nodes[zone]) {
        const double dx = node.x() - at.x_m, dy = node.y() - at.y_m;
        const double distance = std::sqrt(dx * dx + dy * dy);
        if (distance <= radius) expected.emplace_back(distance, zone, node.id());
      }
    }
    std::ranges::sort(expected);
    expected.resize(std::min(expected.size(), most));
    std::vector<NodeStore::Found> found;
    const auto complete = store->nearest({at, radius, most}, only_even, found);
    ASSERT_TRUE(complete.ok() && *complete);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t n = 0; n < found.size(); ++n) {
      ASSERT_EQ(std::tuple(found[n].distance_m, found[n].zone, found[n].node.id()), expected[n]);
    }
  }
}

// Every zone's box holds the point, so every block would have to be read.
TEST_F(Store, SaysWhenItLookedAtAsMuchAsItMayAndIsNotSure) {
  Nodes nodes;
  for (std::size_t zone = 0; zone < NodeStore::kMostBlocks + 1; ++zone) {
    nodes.push_back({fb::Node(-500, 0, 0, 0, 1), fb::Node(500, 0, 0, 0, 2)});
  }
  write_map(folder.path(), nodes);
  auto store = open();
  ASSERT_TRUE(store.ok());
  std::vector<NodeStore::Found> found;
  const auto everyone = [](ZoneId) { return true; };
  EXPECT_FALSE(*store->nearest({{0, 0}, 1000, 1}, everyone, found));
  EXPECT_EQ(found.size(), 1u);
  nodes.pop_back();
  write_map(folder.path(), nodes);
  store = open();
  EXPECT_TRUE(*store->nearest({{0, 0}, 1000, 1}, everyone, found));
}

TEST_F(Store, AFileChangedInPlaceIsNeverServed) {
  write_map(folder.path(), {scattered(0, 600, random)});
  auto store = open();
  ASSERT_TRUE(store.ok());
  {
    std::fstream file(folder / std::string(kManifestName),
                      std::ios::in | std::ios::out | std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    const std::int32_t id = 599;
    const std::size_t at = text.find(std::string(reinterpret_cast<const char*>(&id), sizeof id));
    ASSERT_NE(at, std::string::npos);
    file.seekp(static_cast<std::streamoff>(at));
    file.put(0);
  }
  EXPECT_TRUE(store->read(0, 0).ok()) << "the other block is whole";
  EXPECT_EQ(store->read(0, 512).error().code, ErrorCode::kBadChecksum);
}

TEST_F(Store, AnotherVersionOfTheMapIsRefusedAndAReplacedOneKeepsWorking) {
  write_map(folder.path(), {scattered(0, 10, random)});
  const auto catalog = Catalog::open(folder.path().string(), kCoreOnly);
  auto store = NodeStore::open(*catalog);
  write_map(folder.path(), {scattered(0, 20, random)});  // by rename
  EXPECT_EQ(store->read(0, 0)->size(), 10u);
  EXPECT_EQ(NodeStore::open(*catalog).error().code, ErrorCode::kMismatch);
}

}  // namespace
}  // namespace zonepack
