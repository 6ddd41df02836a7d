// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/lzf_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace zonepack::packer {
namespace {

using ::testing::HasSubstr;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string decompressed(const std::string& stored, std::uint64_t whole) {
  const File in(std::tmpfile(), &std::fclose), out(std::tmpfile(), &std::fclose);
  std::fwrite(stored.data(), 1, stored.size(), in.get());
  std::rewind(in.get());
  decompress_lzf(in.get(), stored.size(), out.get(), whole, "map.pcd");
  std::rewind(out.get());
  std::string bytes(static_cast<std::size_t>(whole), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), out.get()));
  return bytes;
}

std::string error_of(const std::string& stored, std::uint64_t whole) {
  try {
    decompressed(stored, whole);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// 2: three bytes as they are. 4 << 5, 2: six bytes from three back, over their own end.
TEST(LzfStream, RepeatsWhatItHasWritten) {
  EXPECT_EQ(decompressed(std::string("\x02"
                                     "abc"
                                     "\x80\x02",
                                     6),
                         9),
            "abcabcabc");
}

// 7 << 5, 10: 2 + 7 + 10 bytes from one back.
TEST(LzfStream, ALongMatchHasAByteMore) {
  EXPECT_EQ(decompressed(std::string("\x00"
                                     "x"
                                     "\xE0\x0A\x00",
                                     5),
                         20),
            std::string(20, 'x'));
}

// Matches of 264 bytes until the window of 64 KiB has gone round more than once.
TEST(LzfStream, GoesOnBehindItsWindow) {
  std::string stored(
      "\x00"
      "y",
      2);
  for (int i = 0; i < 600; ++i) stored += std::string("\xE0\xFF\x00", 3);
  EXPECT_EQ(decompressed(stored, 1 + 600 * 264), std::string(1 + 600 * 264, 'y'));
}

TEST(LzfStream, RefusesWhatIsNotWhole) {
  EXPECT_THAT(error_of(std::string("\x80\x02", 2), 9), HasSubstr("before its first"));
  EXPECT_THAT(error_of(std::string("\x02"
                                   "ab",
                                   3),
                       3),
              HasSubstr("ends too early"));
  EXPECT_THAT(error_of(std::string("\x02"
                                   "abc",
                                   4),
                       2),
              HasSubstr("longer than it says"));
  EXPECT_THAT(error_of(std::string("\x02"
                                   "abc",
                                   4),
                       4),
              HasSubstr("shorter than it says"));
  EXPECT_THAT(error_of("", 1), HasSubstr("map.pcd: its compressed data is shorter"));
}

}  // namespace
}  // namespace zonepack::packer
