// SPDX-License-Identifier: Apache-2.0
#include "platform/process/presence.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <thread>

#include "platform/linux/last_error.hpp"

namespace zonepack {
namespace {

constexpr int kOpenFlags = O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW | O_NOCTTY;

Result<void> make(const std::string& path) {
  if (::mkfifo(path.c_str(), 0600) != 0 && errno != EEXIST) return last_error();
  struct stat status;
  if (::lstat(path.c_str(), &status) != 0) return last_error();
  if (!S_ISFIFO(status.st_mode)) return ErrorCode::kExists;
  return {};
}

}  // namespace

Result<Presence> Presence::join(const std::string& path) {
  if (const Result<void> made = make(path); !made) return made.error();
  Descriptor end(::open(path.c_str(), O_RDONLY | kOpenFlags));
  if (!end.is_open()) return last_error();
  return Presence(std::move(end));
}

Result<Presence> Presence::begin(const std::string& path, std::chrono::milliseconds wait) {
  constexpr std::chrono::milliseconds kStep{20};
  if (const Result<void> made = make(path); !made) return made.error();
  for (std::chrono::milliseconds waited{0};; waited += kStep) {
    const Descriptor writer(::open(path.c_str(), O_WRONLY | kOpenFlags));
    if (!writer.is_open() && errno == ENXIO) return join(path);
    if (!writer.is_open()) return last_error();
    if (waited >= wait) return ErrorCode::kBusy;
    std::this_thread::sleep_for(kStep);
  }
}

}  // namespace zonepack
