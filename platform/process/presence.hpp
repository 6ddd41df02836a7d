// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "platform/base/result.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// Shows whether a process that was sent a share() is left, however the others ended. Unlike a
// lock, which any share can release for all, a share can be kept or closed, and nothing else: it is
// the reading end of a FIFO into which nothing is written, and the kernel refuses to open the other
// end once no reader is left.
class Presence {
 public:
  // Joins those who are there. Makes the FIFO, for this user alone, when there is none. kExists:
  // the name is taken by something else; kIo with errno.
  static Result<Presence> join(const std::string& path);

  // The same once nobody is there: tries every 20 ms for up to `wait`, then kBusy. The caller holds
  // a lock that keeps others from joining meanwhile.
  static Result<Presence> begin(const std::string& path, std::chrono::milliseconds wait);

  Result<Descriptor> share() const noexcept { return end_.share(); }

 private:
  explicit Presence(Descriptor end) noexcept : end_(std::move(end)) {}
  Descriptor end_;
};

}  // namespace zonepack
