// SPDX-License-Identifier: Apache-2.0
#include "platform/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <thread>

namespace zonepack {

Result<FileLock> FileLock::acquire(const std::string& path, std::chrono::milliseconds wait) {
  constexpr std::chrono::milliseconds kStep{20};
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file.is_open()) return {ErrorCode::kIo, errno};
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
