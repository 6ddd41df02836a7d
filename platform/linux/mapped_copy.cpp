// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/mapped_copy.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "platform/base/byte_count.hpp"
#include "platform/memory/guarded_copy.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kWindowBytes = 1 * kMiB;

Result<void> copy_window(int fd, std::uint64_t offset, std::span<std::byte> out) noexcept {
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  const std::uint64_t from = offset / page * page;
  const auto skip = static_cast<std::size_t>(offset - from);
  const std::size_t length = skip + out.size();
  void* const window = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, fd, static_cast<off_t>(from));
  if (window == MAP_FAILED) return {ErrorCode::kIo, errno};
  ::madvise(window, length, MADV_RANDOM);    // faults read no more than their page ...
  ::madvise(window, length, MADV_WILLNEED);  // ... and these pages come in one request
  const bool copied =
      guarded_copy(out.data(), static_cast<const std::byte*>(window) + skip, out.size());
  ::munmap(window, length);
  // A file truncated inside its last page reads as zeros there, without a fault.
  struct stat status;
  if (::fstat(fd, &status) != 0) return {ErrorCode::kIo, errno};
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size < offset + out.size()) return {ErrorCode::kTruncated, static_cast<std::int64_t>(size)};
  if (!copied) return {ErrorCode::kIo, EIO};
  return {};
}

}  // namespace

Result<void> copy_mapped(int fd, std::uint64_t offset, std::span<std::byte> out) noexcept {
  while (!out.empty()) {
    const auto piece = out.first(std::min(out.size(), kWindowBytes));
    if (const Result<void> copied = copy_window(fd, offset, piece); !copied) return copied;
    out = out.subspan(piece.size());
    offset += piece.size();
  }
  return {};
}

}  // namespace zonepack
