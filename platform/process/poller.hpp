// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "platform/base/result.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// Waits for many descriptors at once.
//
// Errors: kIo with errno.
// Threads: one; wake() by any.
class Poller {
 public:
  enum Interest : std::uint8_t { kNothing = 0, kReadable = 1, kWritable = 2 };
  struct Ready {
    std::uint32_t token = 0;
    bool readable = false;
    bool writable = false;
    bool closed = false;  // by the peer; earlier data can still be read
  };

  static Result<Poller> create();

  // wait() returns `token`. A closed descriptor removes itself.
  Result<void> add(int fd, std::uint32_t token, Interest interest) noexcept;
  Result<void> change(int fd, std::uint32_t token, Interest interest) noexcept;

  // Returns the descriptors that are ready, at most out.size(); none on timeout, after wake() or
  // when a signal arrives.
  std::span<const Ready> wait(std::span<Ready> out, int timeout_ms) noexcept;

  // Makes the current wait(), or the next one, return.
  void wake() const noexcept;

 private:
  Poller(Descriptor epoll, Descriptor event) : epoll_(std::move(epoll)), event_(std::move(event)) {}
  Descriptor epoll_;
  Descriptor event_;
};

}  // namespace zonepack
