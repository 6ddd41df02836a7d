// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"

namespace zonepack {

// The way of a file's bytes into private memory.
enum class ReadMode : std::uint8_t {
  kDirect,    // past the page cache (O_DIRECT); kBuffered where the file system cannot
  kMapped,    // from mapped windows, whose pages are dropped from the cache behind the reader
  kBuffered,  // pread, and dropped from the cache behind the reader
  kCached,    // pread, and left in the cache: tools, which read a file again and again
};

// The robot's, by measurement: `storage_bench MAP` (tests/bench) loading 22 MB in 24 packs, cold,
// ext4 on virtio, 2 shared cores, closing the packs included; dd alone reads 1240 MB/s.
//              MB/s   CPU ms/MB   a zone's time over dd's, p50   page cache at most, left
//   buffered   920    0.6         1.2                            1.7 MiB, 0
//   mapped     320    3.0         3.6                            1.7 MiB, 0
//   direct     410    1.3         2.8                            28 KiB, 0
//   (cached)   890    0.6         1.2                            all, all
// The first two read ahead while we decode; mapped ones unmap their windows on every core. Beyond
// that, a disk faster than the decoder (2.8 GB/s of stored bytes, warm) waits for it.
inline constexpr ReadMode kDefaultReadMode = ReadMode::kBuffered;

// A file opened for reading, whose bytes are copied out, never looked at in place: a file that
// shrinks, changes or fails under us costs an error code and nothing else. Errors: kNotFound, kIo
// with errno, kTruncated with the offset where the file ends.
//
// Page cache: in all modes but kCached, what reading leaves there is at most kMostPageCache at any
// time (it counts against the memory cgroup of the process) and next to nothing once the file is
// closed. Other readers of the same file lose it from the cache, too.
//
// Threads: read_at() from any; the window calls from one at a time.
class StorageFile {
 public:
  static constexpr ByteCount kMostPageCache = 4 * kMiB;

  // Regular files only.
  static Result<StorageFile> open(const std::string& path, ReadMode mode = ReadMode::kCached);

  StorageFile(StorageFile&& other) noexcept;
  StorageFile& operator=(StorageFile&& other) noexcept;
  ~StorageFile();

  std::uint64_t size() const noexcept { return size_; }  // when it was opened
  ReadMode mode() const noexcept { return mode_; }       // the one in use

  // Fills all of `out` from `offset`, or fails. No allocation. Through mapped windows in kMapped
  // and kDirect, whose own reads need aligned buffers.
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept;

  // The longest window that read_window() brings into this buffer, wherever it starts: the buffer
  // less what direct reads need to align both ends, 4 KiB when it starts on a page, else up to 8.
  std::size_t window_room(std::span<const std::byte> buffer) const noexcept;

  // Brings [offset, offset + size) into `buffer`; the bytes stand somewhere in it. No allocation.
  Result<std::span<const std::byte>> read_window(std::uint64_t offset, std::size_t size,
                                                 std::span<std::byte> buffer) noexcept;

  // Whether windows come through the page cache, a little at a time: read_ahead() serves them.
  bool reads_ahead() const noexcept {
    return mode_ == ReadMode::kMapped || mode_ == ReadMode::kBuffered;
  }

  // Starts to bring these bytes into the page cache, without waiting: for what is soon read by
  // read_at(), or by windows that reads_ahead() tells of, in rising order. False when kMostRanges
  // wait to be read. The caller keeps to kMostAhead altogether. Closing waits for what nobody read,
  // because pages on their way cannot be dropped.
  static constexpr ByteCount kMostAhead = 1 * kMiB;
  static constexpr std::size_t kMostRanges = 16;
  bool read_ahead(std::uint64_t offset, std::uint64_t size) noexcept;

 private:
  explicit StorageFile(int fd, ReadMode mode) : fd_(fd), mode_(mode) {}

  Result<void> probe(std::uint64_t offset, std::uint64_t size) const noexcept;
  Result<std::span<const std::byte>> read_direct(std::uint64_t offset, std::size_t size,
                                                 std::span<std::byte> buffer) noexcept;
  void settle_ahead(std::uint64_t end) noexcept;
  void drop_behind(std::uint64_t end) noexcept;

  int fd_;
  ReadMode mode_;
  std::uint32_t mark_ = 0;  // StorageProbe's
  std::uint64_t size_ = 0;
  std::uint64_t dropped_ = 0;  // the cache holds nothing of ours before this offset
  struct Range {
    std::uint64_t from, to;
  };
  std::array<Range, kMostRanges> ahead_;  // asked for and not yet read
  std::size_t ahead_count_ = 0;
};

// A whole file of at most `limit` bytes (kTooLarge beyond).
Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t limit,
                                         ReadMode mode = ReadMode::kCached);

}  // namespace zonepack
