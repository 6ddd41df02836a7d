// SPDX-License-Identifier: Apache-2.0
// Maps with right digests that ask for more memory than the reader allows.
#include "tests/support/hostile_map.hpp"

#include <gtest/gtest.h>

#include "runtime/map/next_version.hpp"
#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

constexpr ByteCount kMost = 10 * kMiB;
constexpr Digest16 kLineage = {1, 2, 3};

class HostileMap : public testing::TestWithParam<test_support::HostileKind> {
 protected:
  HostileMap() {
    for (const auto& [name, bytes] : test_support::hostile_map(GetParam().name, kLineage).files) {
      test_support::write_bytes(folder_ / name, bytes);
    }
  }
  test_support::TemporaryFolder folder_;
};

TEST_P(HostileMap, IsRefusedBeforeMemoryIsReserved) {
  const auto catalog = Catalog::open(folder_.path().string(), kDefaultPayload, kMost);
  const std::string_view named = GetParam().file;
  if (named == kManifestName) {
    EXPECT_FALSE(catalog.ok());
    return;
  }
  ASSERT_TRUE(catalog.ok()) << catalog.error().message;
  const auto claims = check_claims(*catalog, true, ReadMode::kCached);
  ASSERT_FALSE(claims.ok());
  EXPECT_NE(claims.error().message.find(named), std::string::npos) << claims.error().message;
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostileMap, testing::ValuesIn(test_support::hostile_kinds()),
                         [](const auto& test) {
                           std::string name = test.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Claims, OfAPackThatIsMissingCostOnlyItsZoneWhenOthersClaimAsMuch) {
  test_support::SmallMap map;
  const test_support::TemporaryFolder folder;
  for (const auto& [name, bytes] : map.folder.files) {
    test_support::write_bytes(folder / name, bytes);
  }
  std::filesystem::remove(folder / map.packs[0].file);
  const auto catalog = Catalog::open(folder.path().string(), kDefaultPayload);
  ASSERT_TRUE(catalog.ok());
  EXPECT_TRUE(check_claims(*catalog, true, ReadMode::kCached).ok());
  std::filesystem::remove(folder / map.packs[1].file);
  EXPECT_FALSE(check_claims(*catalog, true, ReadMode::kCached).ok());
  EXPECT_TRUE(check_claims(*catalog, false, ReadMode::kCached).ok());
}

TEST(Manifest, WithAsManyBytesAsAreAllowedIsReadAndWithOneLessRefused) {
  test_support::SmallMap map;
  const test_support::TemporaryFolder folder;
  for (const auto& [name, bytes] : map.folder.files) {
    test_support::write_bytes(folder / name, bytes);
  }
  const auto catalog = Catalog::open(folder.path().string(), kDefaultPayload);
  ASSERT_TRUE(catalog.ok());
  // Three times the file, 80 KiB and 512 bytes, and the tables of two rooms and their door.
  const ByteCount need = catalog->bytes_to_open();
  EXPECT_TRUE(Catalog::open(folder.path().string(), kDefaultPayload, need).ok());
  const auto refused = Catalog::open(folder.path().string(), kDefaultPayload, need - 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kNoRoom);
  EXPECT_EQ(refused.error().message, "reading it and holding its tables takes " +
                                         format_byte_count(need) + ", over the " +
                                         format_byte_count(need - 1) + " that there is for it");
}

}  // namespace
}  // namespace zonepack
