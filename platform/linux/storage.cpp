// SPDX-License-Identifier: Apache-2.0
#include "platform/storage.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace zonepack {

Result<StorageFile> StorageFile::open(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (fd < 0) return {errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kIo, errno};
  StorageFile file(fd, 0);
  struct stat status;
  if (::fstat(fd, &status) != 0) return {ErrorCode::kIo, errno};
  if (!S_ISREG(status.st_mode)) {
    return {ErrorCode::kIo, S_ISDIR(status.st_mode) ? EISDIR : EINVAL};
  }
  file.size_ = static_cast<std::uint64_t>(status.st_size);
  return file;
}

StorageFile::StorageFile(StorageFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), size_(other.size_) {}

StorageFile& StorageFile::operator=(StorageFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  return *this;
}

StorageFile::~StorageFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> StorageFile::read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept {
  while (!out.empty()) {
    const ssize_t got = ::pread(fd_, out.data(), out.size(), static_cast<off_t>(offset));
    if (got < 0) {
      if (errno == EINTR) continue;
      return {ErrorCode::kIo, errno};
    }
    if (got == 0) return {ErrorCode::kTruncated, static_cast<std::int64_t>(offset)};
    out = out.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return {};
}

Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t limit) {
  Result<StorageFile> file = StorageFile::open(path);
  if (!file) return file.error();
  if (file->size() > limit) return {ErrorCode::kTooLarge, static_cast<std::int64_t>(file->size())};
  std::vector<std::byte> bytes(file->size());
  if (const Result<void> read = file->read_at(0, bytes); !read) return read.error();
  return bytes;
}

}  // namespace zonepack
