// SPDX-License-Identifier: Apache-2.0
#include "packer/build/leftovers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "tests/support/small_map.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::write_bytes;
using testing::ElementsAre;
using testing::HasSubstr;

// No process has this number: Linux gives at most 4194304.
constexpr const char* kDeadPart = "pack.zpk.part-2000000000-0";

class Leftovers : public testing::Test {
 protected:
  Leftovers() {
    for (const auto& [name, bytes] : map_.folder.files) write_bytes(folder_ / name, bytes);
  }

  std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const Leftover& leftover : find_leftovers(folder_.path())) names.push_back(leftover.name);
    return names;
  }

  std::string refusal() {
    try {
      find_leftovers(folder_.path());
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  test_support::SmallMap map_;
  test_support::TemporaryFolder folder_;
};

TEST_F(Leftovers, AreNoneInAFreshMap) { EXPECT_THAT(names(), ElementsAre()); }

TEST_F(Leftovers, ArePacksOfEarlierVersionsAndPartsOfKilledBuilds) {
  write_bytes(folder_ / "a-0123456789abcdef.zpk", Bytes(10));
  write_bytes(folder_ / kDeadPart, Bytes(3));
  write_bytes(folder_ / "manifest.zpm.part-2000000000-1", Bytes(2));
  const std::vector<Leftover> found = find_leftovers(folder_.path());
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "a-0123456789abcdef.zpk");
  EXPECT_EQ(found[0].bytes, 10u);
  EXPECT_EQ(found[1].name, "manifest.zpm.part-2000000000-1");
  EXPECT_EQ(found[2].name, kDeadPart);
}

TEST_F(Leftovers, AreNeverFilesThatABuildDoesNotWrite) {
  for (const char* name :
       {"notes.txt", "a.zpk", "backup.zpk", "a-0123456789ABCDEF.zpk", "a-0123456789abcde.zpk",
        "-0123456789abcdef.zpk", "a-0123456789abcdef.zpk.old", "report.html.part-2000000000-0",
        "pack.zpk.part-x-0", "manifest.zpm.bak"}) {
    write_bytes(folder_ / name, Bytes(1));
  }
  std::filesystem::create_directory(folder_ / "b-0123456789abcdef.zpk");
  std::filesystem::create_symlink(folder_ / "notes.txt", folder_ / "c-0123456789abcdef.zpk");
  EXPECT_THAT(names(), ElementsAre());
}

TEST_F(Leftovers, AreNotListedWithoutAManifest) {
  std::filesystem::remove(folder_ / std::string(kManifestName));
  EXPECT_THAT(refusal(), HasSubstr("every pack would be removed"));
}

TEST_F(Leftovers, AreNotListedWithADamagedManifest) {
  Bytes manifest = map_.folder.files[std::string(kManifestName)];
  manifest[100] ^= std::byte{1};
  write_bytes(folder_ / std::string(kManifestName), manifest);
  EXPECT_THAT(refusal(), HasSubstr("bad checksum"));
}

TEST_F(Leftovers, AreNotListedWhileABuildRuns) {
  write_bytes(folder_ / ("pack.zpk.part-" + std::to_string(getpid()) + "-0"), Bytes(1));
  EXPECT_THAT(refusal(), HasSubstr("which still runs"));
}

TEST_F(Leftovers, AreRemovedOneByOne) {
  write_bytes(folder_ / kDeadPart, Bytes(3));
  for (const Leftover& leftover : find_leftovers(folder_.path())) {
    remove_leftover(folder_.path(), leftover);
  }
  EXPECT_THAT(names(), ElementsAre());
  EXPECT_FALSE(std::filesystem::exists(folder_ / kDeadPart));
  EXPECT_TRUE(std::filesystem::exists(folder_ / map_.packs[0].file));
}

TEST_F(Leftovers, OfKilledWritersAreClearedAwayWherePartsOnly) {
  write_bytes(folder_ / "a-0123456789abcdef.zpk", Bytes(10));
  write_bytes(folder_ / kDeadPart, Bytes(3));
  const std::string living = "manifest.zpm.part-" + std::to_string(getpid()) + "-0";
  write_bytes(folder_ / living, Bytes(3));
  write_bytes(folder_ / "report.html.part-2000000000-0", Bytes(3));
  remove_parts_of_killed(folder_.path());
  EXPECT_FALSE(std::filesystem::exists(folder_ / kDeadPart));
  EXPECT_TRUE(std::filesystem::exists(folder_ / living));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "report.html.part-2000000000-0"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a-0123456789abcdef.zpk"));
}

}  // namespace
}  // namespace zonepack::packer
