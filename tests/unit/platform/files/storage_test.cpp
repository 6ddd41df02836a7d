// SPDX-License-Identifier: Apache-2.0
#include "platform/files/storage.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "tests/support/numbered_file.hpp"
#include "tests/support/page_cache.hpp"

namespace zonepack {
namespace {

using test_support::are_numbers;
using test_support::cached_bytes;
using test_support::make_cold;
using test_support::NumberedFile;

constexpr std::size_t kBufferBytes = 64 * 1024;

class Storage : public testing::TestWithParam<ReadMode> {
 protected:
  StorageFile open(const NumberedFile& file) {
    return StorageFile::open(file.path().string(), GetParam(), queue_.get()).value();
  }

  std::unique_ptr<ReadQueue> queue_ = ReadQueue::make();
  std::byte buffer_[kBufferBytes];
};

TEST_P(Storage, BringsTheSameBytesWhereverAWindowStarts) {
  const NumberedFile file(300'001);
  for (const bool ahead : {false, true}) {
    StorageFile opened = open(file);
    EXPECT_EQ(opened.size(), 300'001u);
    for (const std::uint64_t offset : {0ul, 1ul, 511ul, 512ul, 4095ul, 4096ul, 200'000ul}) {
      if (ahead) opened.read_ahead(offset, 300'001 - offset);
      const auto window = opened.read_window(offset, kBufferBytes, buffer_);
      ASSERT_TRUE(window) << offset;
      EXPECT_EQ(window->size(), kBufferBytes);
      EXPECT_TRUE(are_numbers(*window, offset)) << offset;
      const auto last = opened.read_window(300'000, 1, buffer_);
      ASSERT_TRUE(last);
      EXPECT_TRUE(are_numbers(*last, 300'000));
    }
  }
}

TEST_P(Storage, BringsAFileLargerThanTheQueueWhileItReadsAhead) {
  constexpr std::uint64_t kBytes = 3 * ReadQueue::kBytes + 12'345;
  const NumberedFile file(kBytes);
  for (const std::size_t size : {kBufferBytes, std::size_t{50'000}}) {  // the second wraps inside
    StorageFile opened = open(file);
    std::uint64_t asked = 0;
    for (std::uint64_t at = 0; at < kBytes; at += size) {
      const std::uint64_t to = std::min<std::uint64_t>(kBytes, at + opened.most_ahead());
      if (opened.reads_ahead() && to > asked && opened.read_ahead(asked, to - asked)) asked = to;
      const auto window =
          opened.read_window(at, std::min(size, static_cast<std::size_t>(kBytes - at)), buffer_);
      ASSERT_TRUE(window);
      ASSERT_TRUE(are_numbers(*window, at)) << at;
    }
  }
}

TEST_P(Storage, FillsAnySpanFromAnyOffset) {
  const NumberedFile file(3'000'001);  // over two mapped windows
  const StorageFile opened = open(file);
  std::vector<std::byte> out(2'999'000);
  ASSERT_TRUE(opened.read_at(1001, out));
  EXPECT_TRUE(are_numbers(out, 1001));
  std::ranges::fill(out, std::byte{});
  ASSERT_TRUE(opened.read_at(999, out));
  EXPECT_TRUE(are_numbers(out, 999));
  const auto whole = read_file(file.path().string(), 3'000'001, GetParam());
  ASSERT_TRUE(whole);
  EXPECT_TRUE(are_numbers(*whole, 0));
  EXPECT_EQ(read_file(file.path().string(), 3'000'000, GetParam()).error(),
            (Error{ErrorCode::kTooLarge, 3'000'001}));
}

TEST_P(Storage, AFileCutShortAfterItWasOpenedEndsWhereItEndsNow) {
  NumberedFile file(100'000);
  StorageFile opened = open(file);
  for (const std::uint64_t size : {70'000ul, 65'536ul, 4096ul, 100ul, 0ul}) {
    file.cut_to(size);
    const Error cut{ErrorCode::kTruncated, static_cast<std::int64_t>(size)};
    const auto window = opened.read_window(0, 50'000, buffer_);
    if (size < 50'000) {
      EXPECT_EQ(window.error(), cut);
    } else {
      ASSERT_TRUE(window);
      EXPECT_TRUE(are_numbers(*window, 0));
    }
    std::vector<std::byte> out(100'000);
    EXPECT_EQ(opened.read_at(0, out).error(), cut);
  }
}

TEST_P(Storage, LeavesLittleInThePageCacheAtAnyTime) {
  constexpr std::uint64_t kBytes = 12 * kMiB;
  const NumberedFile file(kBytes);
  if (!make_cold(file.path())) GTEST_SKIP() << "a file system in memory: nothing can be dropped";
  std::uint64_t most = 0;
  for (const bool ahead : {true, false}) {
    StorageFile opened = open(file);
    for (std::uint64_t at = 0; at < kBytes; at += kBufferBytes) {
      if (ahead) opened.read_ahead(at, StorageFile::kMostAhead);
      ASSERT_TRUE(opened.read_window(at, kBufferBytes, buffer_));
      most = std::max(most, cached_bytes(file.path()));
    }
  }
  if (GetParam() == ReadMode::kCached) {
    EXPECT_EQ(cached_bytes(file.path()), kBytes);  // the baseline for the others
  } else {
    EXPECT_LE(most, StorageFile::kMostPageCache);
    EXPECT_EQ(cached_bytes(file.path()), 0u);
  }
}

TEST_P(Storage, ClosedInTheMidstOfReadingAheadItLeavesNothing) {
  const NumberedFile file(4 * kMiB);
  if (!make_cold(file.path())) GTEST_SKIP() << "a file system in memory: nothing can be dropped";
  if (GetParam() == ReadMode::kCached) return;
  for (std::uint64_t at = 0; at < 4 * kMiB; at += StorageFile::kMostAhead) {
    open(file).read_ahead(at, StorageFile::kMostAhead);
    EXPECT_EQ(cached_bytes(file.path()), 0u);
  }
  std::uint64_t soon = 0;  // bytes that were still being fetched would be there now
  for (int look = 0; look < 20; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    soon = std::max(soon, cached_bytes(file.path()));
  }
  EXPECT_EQ(soon, 0u);
}

TEST_P(Storage, OpensRegularFilesOnly) {
  const test_support::TemporaryFolder folder;
  const auto why = [&](const std::string& path) {
    return StorageFile::open(path, GetParam()).error();
  };
  EXPECT_EQ(why((folder / "none").string()), (Error{ErrorCode::kNotFound, ENOENT}));
  EXPECT_EQ(why(folder.path().string()).code, ErrorCode::kIo);
  const std::string pipe = (folder / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(why(pipe).code, ErrorCode::kIo);  // without waiting for a writer
}

INSTANTIATE_TEST_SUITE_P(Modes, Storage,
                         testing::Values(ReadMode::kDirect, ReadMode::kMapped, ReadMode::kBuffered,
                                         ReadMode::kCached));

TEST(StorageFile, ReadsPastTheCacheByAQueueOneFileAtATime) {
  const auto queue = ReadQueue::make();
  if (!queue) GTEST_SKIP() << "this kernel has no asynchronous reads";
  const NumberedFile file(1'000'000);
  if (!make_cold(file.path())) GTEST_SKIP() << "a file system in memory: the cache is all it has";
  const auto open = [&](ReadQueue* by) {
    return StorageFile::open(file.path().string(), ReadMode::kDirect, by).value();
  };
  EXPECT_EQ(open(nullptr).mode(), ReadMode::kBuffered);
  std::byte buffer[1000];
  {
    StorageFile first = open(queue.get());
    EXPECT_EQ(first.mode(), ReadMode::kDirect);
    EXPECT_EQ(open(queue.get()).mode(), ReadMode::kBuffered);
    first.read_ahead(0, 1'000'000);
    const auto window = first.read_window(999'000, 1000, buffer);
    ASSERT_TRUE(window);
    EXPECT_TRUE(are_numbers(*window, 999'000));
    EXPECT_NE(window->data(), buffer) << "in the queue's own memory";
    EXPECT_EQ(cached_bytes(file.path()), 0u);
  }
  EXPECT_EQ(open(queue.get()).mode(), ReadMode::kDirect) << "and again when the first is closed";
}

TEST(StorageFile, ReadsThroughTheCacheWhereDirectReadsAreRefused) {
  // The kernel's own files do not support direct reads.
  const std::string path = "/sys/kernel/notes";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const auto queue = ReadQueue::make();
  auto opened = StorageFile::open(path, ReadMode::kDirect, queue.get());
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->mode(), ReadMode::kBuffered);
  std::byte buffer[64];
  const auto window = opened->read_window(4, 8, buffer);
  ASSERT_TRUE(window);
  std::byte other[8];
  ASSERT_TRUE(StorageFile::open(path)->read_at(4, other));
  EXPECT_TRUE(std::ranges::equal(*window, other));
}

}  // namespace
}  // namespace zonepack
