// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "platform/files/descriptor.hpp"

namespace zonepack {

// A lock that belongs to an open file description: every process that was sent a share of the
// descriptor holds it too, and it ends with the last of them, however they end. Any of them can
// also release it for all, so a share goes only to a process that is trusted with that: the service
// manager, not a client (presence.hpp).
class FileLock {
 public:
  // Creates the file if it does not exist (its content does not matter). Retries every 20 ms for up
  // to `wait`; kBusy when others still hold the lock then, kExists when something other than a
  // regular file has its name, kIo with errno.
  static Result<FileLock> acquire(const std::string& path, std::chrono::milliseconds wait);

  // Takes back a share: kBusy when it does not hold the lock and another descriptor does.
  static Result<FileLock> adopt(Descriptor file);

  const Descriptor& file() const noexcept { return file_; }

 private:
  explicit FileLock(Descriptor file) noexcept : file_(std::move(file)) {}
  Descriptor file_;
};

}  // namespace zonepack
