// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "platform/base/result.hpp"

namespace zonepack {

// A file that only grows. It keeps little in the page cache, which counts against the memory limit
// of the process that wrote it: after every kSettleBytes, the appended bytes are written back and
// dropped.
//
// Errors: kIo with errno; after an error the file ends where the last complete append() ended.
// Threads: append(), settle() and sync() by one thread at a time, read_at() by any. Not for the
// control thread: each call may wait for the storage.
class AppendFile {
 public:
  static constexpr std::uint64_t kSettleBytes = std::uint64_t{256} * 1024;

  // Creates the file, or truncates an existing one.
  static Result<AppendFile> create(const std::string& path);
  // A file without a name in `folder`; it disappears when closed.
  static Result<AppendFile> create_unnamed(const std::string& folder);

  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&&) = delete;
  ~AppendFile();

  // Appends all of the bytes, or none.
  Result<void> append(std::span<const std::byte> bytes) noexcept;
  std::uint64_t size() const noexcept { return size_; }

  // Fills all of `out`; kTruncated beyond the end.
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept;

  // Writes back and drops what the page cache holds of the file.
  void settle() noexcept;
  // Drops what reading left in the page cache. Callable from any thread.
  void forget() const noexcept;
  // Makes everything appended so far durable.
  Result<void> sync() noexcept;

 private:
  explicit AppendFile(int fd) noexcept : fd_(fd) {}
  int fd_;
  std::uint64_t size_ = 0;
  std::uint64_t settled_ = 0;
};

// Writes back and drops what the page cache holds of an open file; for files of other
// classes.
void drop_page_cache(int descriptor) noexcept;

}  // namespace zonepack
