// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "platform/descriptor.hpp"

namespace zonepack {

// A lock on a file that belongs to the open file: whoever was sent a share of it holds the lock
// too, and it ends with the last of them, however they end. Who waits learns of holders that no
// longer answer, such as readers of a process that crashed.
class FileLock {
 public:
  // Makes the file if there is none (its content does not matter). Tries again every 20 ms for as
  // long as `wait`; kBusy when others hold it to the end, kIo with errno.
  static Result<FileLock> acquire(const std::string& path, std::chrono::milliseconds wait);

  // A share handed back: kBusy when it does not hold the lock and another does.
  static Result<FileLock> adopt(Descriptor file);

  const Descriptor& file() const noexcept { return file_; }

 private:
  explicit FileLock(Descriptor file) noexcept : file_(std::move(file)) {}
  Descriptor file_;
};

}  // namespace zonepack
