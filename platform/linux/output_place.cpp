// SPDX-License-Identifier: Apache-2.0
#include "platform/files/output_place.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "platform/linux/last_error.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kReaderWait_ns = 1'000'000'000;
constexpr std::int64_t kReaderLook_ns = 20'000'000;

}  // namespace

std::string folder_of_path(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

Result<void> check_output_place(const std::string& path, Overwriting how) noexcept {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return {ErrorCode::kIo, EISDIR};
    // A device or a pipe is always written as it stands.
    if (!S_ISREG(status.st_mode) || how == Overwriting::kInPlace) {
      return ::access(path.c_str(), W_OK) == 0 ? Result<void>() : Result<void>(last_error());
    }
  }
  const std::string folder = folder_of_path(path);
  if (::stat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    return {ErrorCode::kNotFound, errno};
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return last_error();
  return {};
}

Result<Descriptor> open_in_place(const std::string& path, bool create) noexcept {
  const int flags =
      O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK | (create ? O_CREAT | O_TRUNC : O_APPEND);
  const std::int64_t until_ns = monotonic_ns() + kReaderWait_ns;
  Descriptor file(::open(path.c_str(), flags, 0666));
  while (!file.is_open() && errno == ENXIO && monotonic_ns() < until_ns) {
    sleep_until_ns(monotonic_ns() + kReaderLook_ns);
    file = Descriptor(::open(path.c_str(), flags, 0666));
  }
  if (!file.is_open()) return last_error();
  // Not to wait was for the opening only.
  const int now = ::fcntl(file.get(), F_GETFL);
  if (now < 0 || ::fcntl(file.get(), F_SETFL, now & ~O_NONBLOCK) != 0) return last_error();
  return file;
}

}  // namespace zonepack
