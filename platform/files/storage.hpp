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
#include "platform/files/read_queue.hpp"

namespace zonepack {

// How a file's bytes get into private memory.
enum class ReadMode : std::uint8_t {
  kDirect,    // read_ahead() bypasses the page cache by a ReadQueue; the rest as kBuffered
  kMapped,    // from mapped windows, whose pages are dropped from the cache after reading
  kBuffered,  // pread, and dropped from the cache after reading
  kCached,    // pread, and left in the cache: for tools that read a file repeatedly
};

// The robot's, by measurement: `storage_bench MAP` (tests/bench) loading 22 MB in 24 packs, cold,
// ext4 on virtio, 2 shared cores, closing the packs included; dd alone reads 1100 to 1300 MB/s.
//              MB/s   CPU ms/MB   a zone's time over dd's, p50, p99   page cache at most, left
//   direct     1800   0.3         0.6   1.1                           24 KiB, 0
//   buffered    900   0.6         1.3   2 to 3                        1.8 MiB, 0
//   mapped      330   2.8         3     7                             1.8 MiB, 0
//   (cached)   1000   0.5         1.2   2                             all, all
// All read ahead while the caller decodes; unmapping the mapped windows interrupts every core.
inline constexpr ReadMode kDefaultReadMode = ReadMode::kDirect;

// A file opened for reading. Its bytes are copied out and never used in place, so a file that
// shrinks, changes or fails meanwhile costs an error code and nothing else.
//
// Errors: kNotFound, kIo with errno, kTruncated with the offset where the file ends.
// Memory: in all modes but kCached, reading leaves at most kMostPageCache in the page cache at any
// time (it counts against the memory cgroup of the process) and next to nothing once the file is
// closed. Other readers of the same file lose those cached pages, too.
// Threads: read_at() by any; with kDirect only by the thread that makes the other calls.
class StorageFile {
 public:
  static constexpr ByteCount kMostPageCache = 4 * kMiB;

  // Opens regular files only. kDirect falls back to kBuffered without a queue, when another file
  // uses the queue, and where the file system has no direct reads. The queue must outlive the file.
  static Result<StorageFile> open(const std::string& path, ReadMode mode = ReadMode::kCached,
                                  ReadQueue* queue = nullptr);

  StorageFile(StorageFile&& other) noexcept;
  StorageFile& operator=(StorageFile&& other) noexcept;
  ~StorageFile();

  std::uint64_t size() const noexcept { return size_; }  // when it was opened
  ReadMode mode() const noexcept { return mode_; }       // the one in use

  // Fills all of `out` from `offset`, or fails; kMapped reads through mapped windows. No
  // allocation.
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept;

  // Returns [offset, offset + size), copied to `buffer` (of that size or more) or in memory that
  // stays valid until the next window. No allocation.
  Result<std::span<const std::byte>> read_window(std::uint64_t offset, std::size_t size,
                                                 std::span<std::byte> buffer) noexcept;

  // Whether read_ahead() speeds up later reads.
  bool reads_ahead() const noexcept { return mode_ != ReadMode::kCached; }

  // Starts fetching these bytes without waiting: expect() for what read_at() reads soon,
  // read_ahead() for windows in rising order. False when there is no room for some of them; try
  // again after reading more. The caller asks for at most most_ahead() in total. Closing waits for
  // the bytes that were not read, because fetching cannot be cancelled.
  static constexpr ByteCount kMostAhead = 1 * kMiB;
  static constexpr std::size_t kMostRanges = 16;
  ByteCount most_ahead() const noexcept {
    return mode_ == ReadMode::kDirect ? ReadQueue::kBytes - ReadQueue::kPieceBytes : kMostAhead;
  }
  bool expect(std::uint64_t offset, std::uint64_t size) noexcept;
  bool read_ahead(std::uint64_t offset, std::uint64_t size) noexcept;

 private:
  explicit StorageFile(int fd, ReadMode mode) : fd_(fd), mode_(mode) {}

  Result<void> probe(std::uint64_t offset, std::uint64_t size) const noexcept;
  void settle_ahead(std::uint64_t end) noexcept;
  void drop_behind(std::uint64_t end) noexcept;

  int fd_;
  ReadMode mode_;
  ReadQueue* queue_ = nullptr;  // with kDirect
  std::uint32_t mark_ = 0;      // StorageProbe's
  std::uint64_t size_ = 0;
  std::uint64_t dropped_ = 0;  // none of our pages before this offset are in the cache
  struct Range {
    std::uint64_t from, to;
  };
  std::array<Range, kMostRanges> ahead_;  // requested and not yet read
  std::size_t ahead_count_ = 0;
};

// A whole file of at most `limit` bytes (kTooLarge beyond).
Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t limit,
                                         ReadMode mode = ReadMode::kCached);

}  // namespace zonepack
