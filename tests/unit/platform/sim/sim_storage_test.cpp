// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_storage.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <thread>

#include "platform/files/storage.hpp"
#include "tests/support/numbered_file.hpp"

namespace zonepack {
namespace {

using test_support::NumberedFile;

constexpr Error kBroken{ErrorCode::kIo, EIO};

TEST(SimStorage, FailsReadsBehindAnOffsetOfOneFileUntilItIsHealed) {
  const NumberedFile bad(10'000), good(10'000);
  SimStorage disk;
  disk.fail_reads(bad.path().string(), 5000, kBroken);
  std::byte out[100];
  const auto file = StorageFile::open(bad.path().string());
  EXPECT_TRUE(file->read_at(4900, out));
  EXPECT_EQ(file->read_at(4901, out).error(), kBroken);
  EXPECT_EQ(file->read_at(8000, out).error(), kBroken);
  EXPECT_TRUE(StorageFile::open(good.path().string())->read_at(8000, out));
  disk.heal();
  EXPECT_TRUE(file->read_at(4901, out));
}

TEST(SimStorage, FailsToOpen) {
  const NumberedFile file(1);
  SimStorage disk;
  disk.fail_open("numbers", {ErrorCode::kIo, EMFILE});
  EXPECT_EQ(StorageFile::open(file.path().string()).error(), (Error{ErrorCode::kIo, EMFILE}));
}

TEST(SimStorage, RecordsWhatWasRead) {
  const NumberedFile file(10'000);
  SimStorage disk;
  std::byte out[100];
  ASSERT_TRUE(StorageFile::open(file.path().string())->read_at(300, out));
  ASSERT_EQ(disk.reads().size(), 1u);
  EXPECT_EQ(disk.reads()[0].path, file.path().string());
  EXPECT_EQ(disk.reads()[0].offset, 300u);
  EXPECT_EQ(disk.reads()[0].size, 100u);
}

TEST(SimStorage, HoldsAReaderUntilItIsReleased) {
  const NumberedFile file(10'000);
  SimStorage disk;
  disk.hold_reads("numbers");
  bool done = false;
  {
    const std::jthread reader([&] {
      std::byte out[100];
      done = StorageFile::open(file.path().string())->read_at(0, out).ok();
    });
    while (!disk.holding()) std::this_thread::yield();
    disk.release();
  }
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace zonepack
