// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/stored_map.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class StoredMapTest : public testing::Test {
 protected:
  StoredMapTest() : map({recipe(1, 2)}, {recipe(2, 6)}) {}

  static test_support::SignatureRecipe recipe(std::int32_t id, float x) {
    test_support::SignatureRecipe out;
    out.id = id;
    out.x = x;
    out.y = 2;
    return out;
  }
  std::string written() {
    map.write_manifest();
    for (const auto& [name, bytes] : map.folder.files) {
      test_support::write_bytes(folder / name, bytes);
    }
    return folder.path().string();
  }

  test_support::TemporaryFolder folder;
  test_support::SmallMap map;
};

TEST_F(StoredMapTest, SaysWhatItsManifestSays) {
  map.content.detector = "8 Kp/MaxFeatures:300";
  const auto opened = open_stored_map(written());
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  EXPECT_EQ(opened->detector.max_features, 300);
  ASSERT_EQ(opened->catalog.zones.size(), 2u);
  EXPECT_EQ(opened->catalog.zones[1].name, "b");
}

TEST_F(StoredMapTest, GivesTheFeaturesOfOneZone) {
  const auto opened = open_stored_map(written());
  ASSERT_TRUE(opened.ok());
  const auto features = read_zone_features(*opened, 1);
  ASSERT_TRUE(features.ok()) << features.error().message;
  ASSERT_EQ(features->size(), 1u);
  EXPECT_EQ(features->front().id, 2u);
  EXPECT_EQ(features->front().zone, 1u);
  EXPECT_EQ(features->front().points.size(), 12u);  // of 20, as in map_features_test.cpp
}

TEST_F(StoredMapTest, NamesAFolderThatHoldsNoMap) {
  const auto opened = open_stored_map(folder.path().string());
  ASSERT_FALSE(opened.ok());
  EXPECT_THAT(opened.error().message,
              AllOf(HasSubstr(folder / "manifest.zpm"), HasSubstr("zonepack build")));
}

TEST_F(StoredMapTest, NamesADetectorThatItCannotFollow) {
  map.content.detector = "6";
  const std::string name = written();
  const auto opened = open_stored_map(name);
  ASSERT_FALSE(opened.ok());
  EXPECT_THAT(opened.error().message, AllOf(HasSubstr(name), HasSubstr("GFTT/BRIEF")));
}

TEST_F(StoredMapTest, NamesThePackAndTheZoneThatCannotBeRead) {
  const auto opened = open_stored_map(written());
  ASSERT_TRUE(opened.ok());
  const std::string pack = folder / opened->catalog.zones[1].pack;
  auto bytes = test_support::read_bytes(pack);
  bytes[bytes.size() / 2] ^= std::byte{1};
  test_support::write_bytes(pack, bytes);
  EXPECT_TRUE(read_zone_features(*opened, 0).ok());
  const auto damaged = read_zone_features(*opened, 1);
  ASSERT_FALSE(damaged.ok());
  EXPECT_THAT(damaged.error().message, AllOf(HasSubstr(pack), HasSubstr("zone 'b' cannot be read"),
                                             HasSubstr("zonepack verify")));
  std::filesystem::remove(pack);
  const auto gone = read_zone_features(*opened, 1);
  ASSERT_FALSE(gone.ok());
  EXPECT_THAT(gone.error().message, AllOf(HasSubstr(pack), HasSubstr("not found")));
}

}  // namespace
}  // namespace zonepack::localize
