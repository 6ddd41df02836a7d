// SPDX-License-Identifier: Apache-2.0
#include "platform/files/append_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "platform/linux/last_error.hpp"

namespace zonepack {

Result<AppendFile> AppendFile::create(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, 0666);
  if (fd < 0) return last_error();
  return AppendFile(fd);
}

Result<AppendFile> AppendFile::create_unnamed(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
  if (fd < 0) return last_error();
  return AppendFile(fd);
}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), size_(other.size_), settled_(other.settled_) {}

AppendFile::~AppendFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> AppendFile::append(std::span<const std::byte> bytes) noexcept {
  std::uint64_t end = size_;
  while (!bytes.empty()) {
    const ::ssize_t written = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<::off_t>(end));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const Error error{ErrorCode::kIo, written == 0 ? ENOSPC : errno};
      if (end > size_ && ::ftruncate(fd_, static_cast<::off_t>(size_)) != 0) return last_error();
      return error;
    }
    end += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  size_ = end;
  if (size_ - settled_ >= kSettleBytes) settle();
  return {};
}

Result<void> AppendFile::read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept {
  while (!out.empty()) {
    const ::ssize_t got = ::pread(fd_, out.data(), out.size(), static_cast<::off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return last_error();
    if (got == 0) return {ErrorCode::kTruncated, static_cast<std::int64_t>(offset)};
    out = out.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return {};
}

void AppendFile::settle() noexcept {
  drop_page_cache(fd_);
  settled_ = size_;
}

void AppendFile::forget() const noexcept { ::posix_fadvise(fd_, 0, 0, POSIX_FADV_DONTNEED); }

Result<void> AppendFile::sync() noexcept {
  if (::fsync(fd_) != 0) return last_error();
  return {};
}

void drop_page_cache(int descriptor) noexcept {
  // Only clean pages can be dropped. Both calls are hints: a file system that ignores them keeps
  // more.
  ::sync_file_range(
      descriptor, 0, 0,
      SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER);
  // From offset 0, since a smaller window leaves pages of large folios behind.
  ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED);
}

}  // namespace zonepack
