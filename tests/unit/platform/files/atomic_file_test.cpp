// SPDX-License-Identifier: Apache-2.0
#include "platform/files/atomic_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public testing::Test {
 protected:
  std::string path(const char* name) const { return (folder_ / name).string(); }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      names.insert(entry.path().filename());
    return names;
  }
  static std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(AtomicFileTest, AppearsOnlyWhenCommitted) {
  Result<AtomicFile> file = AtomicFile::create(path("map"));
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file->write("one ").ok());
  ASSERT_TRUE(file->write("two").ok());
  EXPECT_FALSE(fs::exists(path("map")));
  ASSERT_EQ(files().size(), 1u);
  EXPECT_TRUE(is_part_name(*files().begin()));
  ASSERT_TRUE(file->commit().ok());
  EXPECT_EQ(files(), std::set<std::string>{"map"});
  EXPECT_EQ(read(path("map")), "one two");
}

TEST_F(AtomicFileTest, WritesAPipeInPlace) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_TRUE(write_file_atomically(path("pipe"), "words").ok());
  char got[8];
  EXPECT_EQ(::read(reader, got, sizeof got), 5);
  close(reader);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_EQ(files(), std::set<std::string>{"pipe"});
}

TEST_F(AtomicFileTest, LeavesDevicesWhatTheyAre) {
  ASSERT_TRUE(write_file_atomically("/dev/null", "words").ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, ReplacesFilesOfAFileSystemBelowDev) {
  if (access("/dev/shm", W_OK) != 0) GTEST_SKIP() << "/dev/shm cannot be written here";
  const std::string file = "/dev/shm/zonepack-atomic-" + std::to_string(getpid());
  ASSERT_TRUE(write_file_atomically(file, "old").ok());
  ASSERT_TRUE(write_file_atomically(file, "new").ok());
  EXPECT_EQ(read(file), "new");
  fs::remove(file);
}

TEST_F(AtomicFileTest, ReplacesWhatALinkLeadsToAndKeepsTheLink) {
  ASSERT_TRUE(write_file_atomically(path("file"), "old").ok());
  fs::create_symlink("file", path("link"));
  ASSERT_TRUE(write_file_atomically(path("link"), "new").ok());
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read(path("file")), "new");
}

TEST_F(AtomicFileTest, DroppedWithoutCommitLeavesTheOldFileAndNoPart) {
  ASSERT_TRUE(write_file_atomically(path("map"), "old").ok());
  {
    Result<AtomicFile> file = AtomicFile::create(path("map"));
    ASSERT_TRUE(file->write("half of the new").ok());
  }
  EXPECT_EQ(read(path("map")), "old");
  EXPECT_EQ(files(), std::set<std::string>{"map"});
}

TEST_F(AtomicFileTest, ReplacesAnOldFile) {
  ASSERT_TRUE(write_file_atomically(path("map"), "a longer old content").ok());
  ASSERT_TRUE(write_file_atomically(path("map"), "new").ok());
  EXPECT_EQ(read(path("map")), "new");
}

TEST_F(AtomicFileTest, CanBeNamedAtTheEnd) {
  Result<AtomicFile> file = AtomicFile::create(path("pack"));
  ASSERT_TRUE(file->write("bytes").ok());
  ASSERT_TRUE(file->commit_as(path("L1-0123abcd.zpk")).ok());
  EXPECT_EQ(files(), std::set<std::string>{"L1-0123abcd.zpk"});
}

TEST_F(AtomicFileTest, TwoWritersOfOneNameDoNotMix) {
  Result<AtomicFile> first = AtomicFile::create(path("map"));
  Result<AtomicFile> second = AtomicFile::create(path("map"));
  ASSERT_TRUE(first->write("first").ok());
  ASSERT_TRUE(second->write("second").ok());
  ASSERT_TRUE(second->commit().ok());
  EXPECT_EQ(read(path("map")), "second");
  ASSERT_TRUE(first->commit().ok());
  EXPECT_EQ(read(path("map")), "first");
}

TEST_F(AtomicFileTest, NamesTheSystemErrorOfAMissingFolder) {
  const Result<void> result = write_file_atomically(path("no/such/folder/map"), "x");
  EXPECT_EQ(result.error(), (Error{ErrorCode::kIo, ENOENT}));
}

TEST_F(AtomicFileTest, AFailedRenameRemovesThePart) {
  fs::create_directory(folder_ / "map");
  const Result<void> result = write_file_atomically(path("map"), "x");
  EXPECT_EQ(result.error(), (Error{ErrorCode::kIo, EISDIR}));
  EXPECT_EQ(files(), std::set<std::string>{"map"});
}

TEST_F(AtomicFileTest, AFullDeviceIsAnError) {
  Result<AtomicFile> file = AtomicFile::create(path("map"));
  ASSERT_TRUE(file.ok());
  const int full = ::open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  ASSERT_GE(::dup2(full, file->descriptor()), 0);
  ::close(full);
  EXPECT_EQ(file->write("x").error(), (Error{ErrorCode::kIo, ENOSPC}));
}

TEST_F(AtomicFileTest, FollowsTheUmask) {
  const mode_t old = ::umask(027);
  ASSERT_TRUE(write_file_atomically(path("map"), "x").ok());
  ::umask(old);
  struct stat status {};
  ASSERT_EQ(::stat(path("map").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(PartName, IsDistinguishedFromOtherNames) {
  EXPECT_TRUE(is_part_name("manifest.zpm.part-123-0"));
  for (const char* name : {"manifest.zpm", "L1.part", "L1.part-", "L1.part-12", "L1.part-12-",
                           "L1.part-x-1", "L1.part-1-2.zpk", ".part-1-2"}) {
    EXPECT_FALSE(is_part_name(name)) << name;
  }
}

}  // namespace
}  // namespace zonepack
