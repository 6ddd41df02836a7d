// SPDX-License-Identifier: Apache-2.0
#include "platform/files/storage.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <utility>

#include "platform/base/require.hpp"
#include "platform/files/descriptor.hpp"
#include "platform/files/storage_probe.hpp"
#include "platform/linux/mapped_copy.hpp"

namespace zonepack {
namespace {

constexpr std::uint64_t kSmallestPage = 4096;
constexpr ByteCount kDropBytes = 1 * kMiB;
constexpr std::size_t kPieceBytes = 1 * kMiB;

std::atomic<StorageProbe*> probe_in_use = nullptr;

// The same file opened for reads that bypass the page cache; none where the file system has no such
// reads, or the name now leads to another file.
Descriptor open_direct(const std::string& path, int flags, const struct stat& same) noexcept {
  Descriptor direct(::open(path.c_str(), flags | O_DIRECT));
  struct stat status;
  if (!direct.is_open() || ::fstat(direct.get(), &status) != 0) return {};
  if (status.st_dev != same.st_dev || status.st_ino != same.st_ino) return {};
  ::posix_fadvise(direct.get(), 0, 0, POSIX_FADV_RANDOM);
  return direct;
}

// Reading at `at` returned nothing: the file ends there or earlier.
Error truncated(int fd, std::uint64_t at) noexcept {
  struct stat status;
  const bool known = ::fstat(fd, &status) == 0;
  return {ErrorCode::kTruncated,
          std::min(static_cast<std::int64_t>(at),
                   known ? static_cast<std::int64_t>(status.st_size) : INT64_MAX)};
}

Result<void> read_all(int fd, std::uint64_t offset, std::span<std::byte> out) noexcept {
  while (!out.empty()) {
    const ssize_t got = ::pread(fd, out.data(), out.size(), static_cast<off_t>(offset));
    if (got < 0) {
      if (errno == EINTR) continue;
      return {ErrorCode::kIo, errno};
    }
    if (got == 0) return truncated(fd, offset);
    out = out.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return {};
}

// Waits until the pages of a range are present, or cannot be read.
void wait_for(int fd, std::uint64_t from, std::uint64_t to) noexcept {
  for (std::uint64_t at = from; at < to; at += kSmallestPage) {
    std::byte ignored;
    if (::pread(fd, &ignored, 1, static_cast<off_t>(at)) != 1) return;
  }
}

}  // namespace

void set_storage_probe(StorageProbe* probe) noexcept { probe_in_use = probe; }

Result<StorageFile> StorageFile::open(const std::string& path, ReadMode mode, ReadQueue* queue) {
  StorageProbe::FileMark mark = 0;
  if (StorageProbe* const probe = probe_in_use; probe != nullptr) {
    const Result<StorageProbe::FileMark> marked = probe->on_open(path);
    if (!marked) return marked.error();
    mark = *marked;
  }
  constexpr int kFlags = O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK;
  const int fd = ::open(path.c_str(), kFlags);
  if (fd < 0) return {errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kIo, errno};
  StorageFile file(fd, mode);
  file.mark_ = mark;
  struct stat status;
  if (::fstat(fd, &status) != 0) return {ErrorCode::kIo, errno};
  if (!S_ISREG(status.st_mode)) {
    return {ErrorCode::kIo, S_ISDIR(status.st_mode) ? EISDIR : EINVAL};
  }
  file.size_ = static_cast<std::uint64_t>(status.st_size);
  if (mode == ReadMode::kDirect) {
    file.mode_ = ReadMode::kBuffered;
    Descriptor direct;
    if (queue != nullptr && !queue->busy()) direct = open_direct(path, kFlags, status);
    if (direct.is_open()) {
      queue->begin(std::move(direct));
      file.queue_ = queue;
      file.mode_ = ReadMode::kDirect;
    }
  }
  // Disables the kernel's own read-ahead, which is 8 MiB on some machines.
  if (mode != ReadMode::kCached) ::posix_fadvise(fd, 0, 0, POSIX_FADV_RANDOM);
  return file;
}

StorageFile::StorageFile(StorageFile&& other) noexcept : StorageFile(-1, ReadMode::kCached) {
  *this = std::move(other);
}

StorageFile& StorageFile::operator=(StorageFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(mode_, other.mode_);
  std::swap(queue_, other.queue_);
  std::swap(mark_, other.mark_);
  std::swap(size_, other.size_);
  std::swap(dropped_, other.dropped_);
  std::swap(ahead_, other.ahead_);
  std::swap(ahead_count_, other.ahead_count_);
  return *this;
}

StorageFile::~StorageFile() {
  if (fd_ < 0) return;
  if (queue_ != nullptr) queue_->end();
  if (mode_ != ReadMode::kCached) {
    for (std::size_t i = 0; i < ahead_count_; ++i) wait_for(fd_, ahead_[i].from, ahead_[i].to);
    ::posix_fadvise(fd_, 0, 0, POSIX_FADV_DONTNEED);
  }
  ::close(fd_);
}

Result<void> StorageFile::probe(std::uint64_t offset, std::uint64_t size) const noexcept {
  StorageProbe* const probe = mark_ == 0 ? nullptr : probe_in_use.load();
  return probe == nullptr ? Result<void>() : probe->on_read(mark_, offset, size);
}

Result<void> StorageFile::read_at(std::uint64_t offset, std::span<std::byte> out) const noexcept {
  if (const Result<void> allowed = probe(offset, out.size()); !allowed) return allowed;
  if (queue_ != nullptr) {
    if (const auto there = queue_->find(offset, out.size(), out)) {
      if (there->data() != out.data()) std::ranges::copy(*there, out.begin());
      return {};
    }
  }
  return mode_ == ReadMode::kMapped ? copy_mapped(fd_, offset, out) : read_all(fd_, offset, out);
}

Result<std::span<const std::byte>> StorageFile::read_window(std::uint64_t offset, std::size_t size,
                                                            std::span<std::byte> buffer) noexcept {
  ZP_REQUIRE(size <= buffer.size());
  if (const Result<void> allowed = probe(offset, size); !allowed) return allowed.error();
  if (queue_ != nullptr) {
    queue_->pass(offset);
    if (const auto there = queue_->find(offset, size, buffer)) {
      drop_behind(offset + size);  // some file systems serve direct reads from the cache
      return *there;
    }
  }
  const std::span<std::byte> out = buffer.first(size);
  const Result<void> read =
      mode_ == ReadMode::kMapped ? copy_mapped(fd_, offset, out) : read_all(fd_, offset, out);
  if (!read) return read.error();
  settle_ahead(offset + size);
  drop_behind(offset + size);
  return std::span<const std::byte>(out);
}

bool StorageFile::read_ahead(std::uint64_t offset, std::uint64_t size) noexcept {
  return queue_ != nullptr ? queue_->ask(offset, size) : expect(offset, size);
}

bool StorageFile::expect(std::uint64_t offset, std::uint64_t size) noexcept {
  if (ahead_count_ == ahead_.size()) return false;
  ::posix_fadvise(fd_, static_cast<off_t>(offset), static_cast<off_t>(size), POSIX_FADV_WILLNEED);
  ahead_[ahead_count_++] = {offset, offset + size};
  return true;
}

// Ranges requested before `end` have been read by now.
void StorageFile::settle_ahead(std::uint64_t end) noexcept {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ahead_count_; ++i) {
    if (ahead_[i].to > end) ahead_[kept++] = {std::max(ahead_[i].from, end), ahead_[i].to};
  }
  ahead_count_ = kept;
}

// From offset 0 each time: dropping piece by piece leaves large folios that span pieces.
void StorageFile::drop_behind(std::uint64_t end) noexcept {
  if (mode_ == ReadMode::kCached || end < dropped_ + kDropBytes) return;
  ::posix_fadvise(fd_, 0, static_cast<off_t>(end), POSIX_FADV_DONTNEED);
  dropped_ = end;
}

Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t limit,
                                         ReadMode mode) {
  Result<StorageFile> file = StorageFile::open(path, mode);
  if (!file) return file.error();
  limit = std::min<std::uint64_t>(limit, PTRDIFF_MAX);
  if (file->size() > limit) return {ErrorCode::kTooLarge, static_cast<std::int64_t>(file->size())};
  std::vector<std::byte> bytes(static_cast<std::size_t>(file->size()));
  for (std::size_t at = 0; at < bytes.size();) {
    const auto piece = std::span(bytes).subspan(at, std::min(bytes.size() - at, kPieceBytes));
    const auto read = file->read_window(at, piece.size(), piece);
    if (!read) return read.error();
    at += piece.size();
  }
  return bytes;
}

}  // namespace zonepack
