// SPDX-License-Identifier: Apache-2.0
#include "platform/files/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <thread>

namespace zonepack {

Result<FileLock> FileLock::acquire(const std::string& path, std::chrono::milliseconds wait) {
  constexpr std::chrono::milliseconds kStep{20};
  // O_NONBLOCK: a FIFO in its place would otherwise wait for a writer.
  constexpr int kFlags = O_RDONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY;
  Descriptor file(::open(path.c_str(), kFlags, 0600));
  if (!file.is_open() && (errno == ELOOP || errno == EISDIR || errno == ENXIO)) {
    return {ErrorCode::kExists, errno};
  }
  if (!file.is_open()) return {ErrorCode::kIo, errno};
  struct stat status;
  if (::fstat(file.get(), &status) != 0) return {ErrorCode::kIo, errno};
  if (!S_ISREG(status.st_mode)) return ErrorCode::kExists;
  for (std::chrono::milliseconds waited{0};; waited += kStep) {
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return FileLock(std::move(file));
    if (errno != EWOULDBLOCK && errno != EINTR) return {ErrorCode::kIo, errno};
    if (waited >= wait) return ErrorCode::kBusy;
    std::this_thread::sleep_for(kStep);
  }
}

Result<FileLock> FileLock::adopt(Descriptor file) {
  if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return FileLock(std::move(file));
  if (errno == EWOULDBLOCK) return ErrorCode::kBusy;
  return {ErrorCode::kIo, errno};
}

}  // namespace zonepack
