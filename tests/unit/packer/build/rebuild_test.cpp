// SPDX-License-Identifier: Apache-2.0
// What a rebuild leaves as it was.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "packer/build/map_builder.hpp"
#include "packer/verify/map_verifier.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::MemoryFolder;

constexpr const char* kRooms = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"name": "hall", "zone_type": "corridor"}, "geometry":
   {"type": "Polygon", "coordinates": [[[0, 0], [10, 0], [10, 4], [0, 4], [0, 0]]]}},
  {"type": "Feature", "properties": {"name": "left", "zone_type": "room"}, "geometry":
   {"type": "Polygon", "coordinates": [[[0, 4], [5, 4], [5, 8], [0, 8], [0, 4]]]}},
  {"type": "Feature", "properties": {"name": "right", "zone_type": "room"}, "geometry":
   {"type": "Polygon", "coordinates": [[[5, 4], [10, 4], [10, 8], [5, 8], [5, 4]]]}}]})";

// Hall: ids 1 to 8 of session 0; left: 11 to 14 of session 1; right: 21 to 24 of session 2.
test_support::RtabmapFixture three_sessions() {
  test_support::RtabmapFixture fixture;
  const auto add = [&](std::int32_t id, std::int32_t session, float x, float y,
                       std::vector<std::int32_t> neighbours) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.map_id = session;
    recipe.x = x;
    recipe.y = y;
    recipe.neighbours = std::move(neighbours);
    fixture.signatures.push_back(test_support::make_signature(recipe));
  };
  for (std::int32_t i = 1; i <= 8; ++i) add(i, 0, static_cast<float>(i), 2, {i % 8 + 1, 11, 21});
  for (std::int32_t i = 11; i <= 14; ++i) add(i, 1, static_cast<float>(i - 10), 6, {3});
  for (std::int32_t i = 21; i <= 24; ++i) add(i, 2, static_cast<float>(i - 15), 6, {7});
  return fixture;
}

class Rebuild : public testing::Test {
 protected:
  Rebuild() {
    std::ofstream(disk_ / "zones.geojson") << kRooms;
    options_.source = disk_ / "map.db";
    options_.zones = disk_ / "zones.geojson";
    options_.out = disk_ / "map";
    build();
    before_ = MemoryFolder::copy_of(options_.out);
  }

  void build() {
    test_support::write_rtabmap_database(options_.source.path, fixture_);
    std::ostringstream silent;
    Progress progress(silent, false);
    build_map(options_, progress);
    EXPECT_TRUE(verify_map(FolderFiles(options_.out)).whole());
  }

  // Packs of a zone that the manifest named before the rebuild, byte for byte as they were.
  bool still_there(const std::string& zone) {
    const MemoryFolder after = MemoryFolder::copy_of(options_.out);
    for (const auto& [name, bytes] : before_.files) {
      if (!name.starts_with(zone + "-")) continue;
      return after.files.contains(name) && after.files.at(name) == bytes;
    }
    return false;
  }
  std::size_t packs_of(const std::string& zone) {
    std::size_t count = 0;
    for (const std::string& name : FolderFiles(options_.out).names()) {
      count += name.starts_with(zone + "-");
    }
    return count;
  }
  void expect_only_right_changed() {
    EXPECT_TRUE(still_there("hall"));
    EXPECT_TRUE(still_there("left"));
    EXPECT_EQ(packs_of("hall"), 1u);
    EXPECT_EQ(packs_of("left"), 1u);
    EXPECT_EQ(packs_of("right"), 2u);  // the old one stays until pruned
  }

  test_support::TemporaryFolder disk_;
  test_support::RtabmapFixture fixture_ = three_sessions();
  BuildOptions options_;
  MemoryFolder before_;
};

TEST_F(Rebuild, OfTheSameDatabaseChangesNoByte) {
  build();
  EXPECT_EQ(MemoryFolder::copy_of(options_.out).files, before_.files);
}

TEST_F(Rebuild, AfterAFeatureOfOneRoomChangedLeavesTheOtherPacksAsTheyWere) {
  fixture_.signatures.back().features.x[0] += 1;
  build();
  expect_only_right_changed();
}

TEST_F(Rebuild, AfterARoomWasMappedAgainLeavesTheOtherPacksAsTheyWere) {
  // Session 2 comes back with other ids, poses, and one signature more.
  fixture_.signatures.resize(12);
  for (std::int32_t i = 31; i <= 35; ++i) {
    test_support::SignatureRecipe recipe;
    recipe.id = i;
    recipe.map_id = 3;
    recipe.x = static_cast<float>(i) - 25.5F;
    recipe.y = 5;
    recipe.neighbours = {7};
    fixture_.signatures.push_back(test_support::make_signature(recipe));
  }
  build();
  expect_only_right_changed();
}

TEST_F(Rebuild, AfterARoomWasEmptiedLeavesTheOtherPacksAsTheyWere) {
  fixture_.signatures.resize(12);
  build();
  expect_only_right_changed();
}

TEST_F(Rebuild, GivesTheSameBytesOnAnyNumberOfJobs) {
  for (const unsigned jobs : {1u, 2u, 5u}) {
    options_.jobs = jobs;
    options_.out = disk_ / ("map" + std::to_string(jobs));
    build();
    EXPECT_EQ(MemoryFolder::copy_of(options_.out).files, before_.files) << jobs << " jobs";
  }
}

}  // namespace
}  // namespace zonepack::packer
