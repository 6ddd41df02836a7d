// SPDX-License-Identifier: Apache-2.0
#include "platform/files/read_stream.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <string>
#include <thread>

#include "platform/base/byte_count.hpp"
#include "tests/support/numbered_file.hpp"
#include "tests/support/page_cache.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack {
namespace {

using test_support::cached_bytes;
using test_support::make_cold;
using test_support::NumberedFile;

std::string all_of(ReadStream& stream) {
  std::string text;
  for (;;) {
    const auto piece = stream.next();
    EXPECT_TRUE(piece.ok());
    if (!piece || piece->empty()) return text;
    text.append(piece->begin(), piece->end());
  }
}

TEST(ReadStream, GivesEveryByteOfAFileInOrder) {
  const test_support::TemporaryFolder folder;
  const std::string path = (folder / "file").string();
  std::string written;
  for (int i = 0; written.size() < 3 * ReadStream::kPieceBytes + 17; ++i) {
    written += std::to_string(i);
  }
  std::ofstream(path) << written;
  auto stream = ReadStream::open(path);
  ASSERT_TRUE(stream.ok());
  EXPECT_EQ(all_of(*stream), written);
}

TEST(ReadStream, LeavesLittleInThePageCacheAtAnyTime) {
  constexpr std::uint64_t kBytes = 8 * kMiB;
  const NumberedFile file(kBytes);
  if (!make_cold(file.path())) GTEST_SKIP() << "a file system in memory: nothing can be dropped";
  std::uint64_t most = 0, read = 0;
  {
    auto stream = ReadStream::open(file.path().string());
    ASSERT_TRUE(stream.ok());
    for (auto piece = stream->next(); piece && !piece->empty(); piece = stream->next()) {
      read += piece->size();
      most = std::max(most, cached_bytes(file.path()));
    }
  }
  EXPECT_EQ(read, kBytes);
  EXPECT_GT(most, 0u);  // it is seen at all
  EXPECT_LE(most, ReadStream::kMostPageCache);
  EXPECT_EQ(cached_bytes(file.path()), 0u);
}

TEST(ReadStream, ReadsAPipeToItsEnd) {
  const test_support::TemporaryFolder folder;
  const std::string path = (folder / "pipe").string();
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(path) << std::string(100'000, 'x'); });
  auto stream = ReadStream::open(path);
  ASSERT_TRUE(stream.ok());
  EXPECT_EQ(all_of(*stream), std::string(100'000, 'x'));
  writer.join();
}

TEST(ReadStream, SaysWhyItCannotRead) {
  const test_support::TemporaryFolder folder;
  EXPECT_EQ(ReadStream::open((folder / "none").string()).error(),
            (Error{ErrorCode::kNotFound, ENOENT}));
  auto directory = ReadStream::open(folder.path().string());
  ASSERT_TRUE(directory.ok());
  EXPECT_EQ(directory->next().error(), (Error{ErrorCode::kIo, EISDIR}));
}

}  // namespace
}  // namespace zonepack
