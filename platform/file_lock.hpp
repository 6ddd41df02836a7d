// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "platform/descriptor.hpp"

namespace zonepack {

// A lock that belongs to an open file description: every process that was sent a share of the
// descriptor holds it too, and it ends with the last of them, however they end. A process that
// cannot get it knows that some holder is left, such as a reader of a process that crashed.
class FileLock {
 public:
  // Creates the file if it does not exist (its content does not matter). Retries every 20 ms for up
  // to `wait`; kBusy when others still hold the lock then, kIo with errno.
  static Result<FileLock> acquire(const std::string& path, std::chrono::milliseconds wait);

  // Takes back a share: kBusy when it does not hold the lock and another descriptor does.
  static Result<FileLock> adopt(Descriptor file);

  const Descriptor& file() const noexcept { return file_; }

 private:
  explicit FileLock(Descriptor file) noexcept : file_(std::move(file)) {}
  Descriptor file_;
};

}  // namespace zonepack
