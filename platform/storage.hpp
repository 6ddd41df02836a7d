// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"

namespace zonepack {

// A file opened for reading, whose bytes are copied out, never looked at in place: a file that
// shrinks, changes or fails under us costs an error code and nothing else. Errors: kNotFound, kIo
// with errno, kTruncated with the offset. Threads: read_at() from any.
class StorageFile {
 public:
  // Regular files only.
  static Result<StorageFile> open(const std::string& path);

  StorageFile(StorageFile&& other) noexcept;
  StorageFile& operator=(StorageFile&& other) noexcept;
  ~StorageFile();

  std::uint64_t size() const noexcept { return size_; }  // when it was opened

  // Fills all of `out` from `offset`, or fails. No allocation.
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept;

 private:
  StorageFile(int fd, std::uint64_t size) : fd_(fd), size_(size) {}
  int fd_;
  std::uint64_t size_;
};

// A whole file of at most `limit` bytes (kTooLarge beyond).
Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t limit);

}  // namespace zonepack
