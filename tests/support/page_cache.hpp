// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <vector>

// What the page cache holds of a file, according to mincore.
namespace zonepack::test_support {

inline std::uint64_t cached_bytes(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status = {};
  if (fd < 0 || ::fstat(fd, &status) != 0 || status.st_size == 0) {
    if (fd >= 0) ::close(fd);
    return 0;
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  void* const map = ::mmap(nullptr, size, PROT_NONE, MAP_SHARED, fd, 0);
  ::close(fd);
  if (map == MAP_FAILED) return 0;
  std::vector<unsigned char> pages((size + page - 1) / page);
  const int failed = ::mincore(map, size, pages.data());
  ::munmap(map, size);
  std::uint64_t bytes = 0;
  for (const unsigned char in_memory : pages) bytes += failed == 0 && (in_memory & 1) ? page : 0;
  return bytes;
}

// Writes a file's pages to the disk and drops them; false where they stay (a file system in
// memory).
inline bool make_cold(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  ::fsync(fd);
  ::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  ::close(fd);
  return cached_bytes(path) == 0;
}

}  // namespace zonepack::test_support
