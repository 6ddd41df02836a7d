// SPDX-License-Identifier: Apache-2.0
#include "platform/files/read_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace zonepack {

Result<ReadStream> ReadStream::open(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
  if (!file.is_open()) return {errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kIo, errno};
  struct stat status;
  const bool regular = ::fstat(file.get(), &status) == 0 && S_ISREG(status.st_mode);
  if (regular) ::posix_fadvise(file.get(), 0, 0, POSIX_FADV_RANDOM);
  return ReadStream(std::move(file), regular);
}

ReadStream::~ReadStream() {
  if (!file_.is_open() || !regular_) return;
  ::posix_fadvise(file_.get(), 0, 0, POSIX_FADV_DONTNEED);
}

Result<std::span<const char>> ReadStream::next() noexcept {
  ssize_t got = 0;
  do {
    got = ::read(file_.get(), piece_.data(), piece_.size());
  } while (got < 0 && errno == EINTR);
  if (got < 0) return {ErrorCode::kIo, errno};
  at_ += static_cast<std::uint64_t>(got);
  if (regular_ && got > 0) {
    if (at_ >= dropped_ + kDropBytes) drop();
    ::posix_fadvise(file_.get(), static_cast<off_t>(at_), kPieceBytes, POSIX_FADV_WILLNEED);
  }
  return std::span<const char>(piece_.data(), static_cast<std::size_t>(got));
}

// From offset 0 each time: dropping piece by piece leaves large folios that span pieces.
void ReadStream::drop() noexcept {
  ::posix_fadvise(file_.get(), 0, static_cast<off_t>(at_), POSIX_FADV_DONTNEED);
  dropped_ = at_;
}

}  // namespace zonepack
