// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "platform/base/result.hpp"

namespace zonepack {

// Owns a file descriptor and closes it; -1 for none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) noexcept : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { close(); }

  int get() const noexcept { return fd_; }
  bool is_open() const noexcept { return fd_ >= 0; }
  int release() noexcept { return std::exchange(fd_, -1); }
  void close() noexcept;

  // Another descriptor of the same open file, locks included. kIo with errno.
  Result<Descriptor> share() const noexcept;

 private:
  int fd_ = -1;
};

// Whether a write of a line (below PIPE_BUF) would not wait: false for a pipe that nobody empties
// and for a terminal that was halted. True where a write would fail at once.
bool takes_a_line_now(int fd) noexcept;

// Writes all of the bytes, in as many pieces as it takes. kIo with errno.
//
// Real-time: may block; not for the control thread.
Result<void> write_all(int fd, std::span<const std::byte> bytes) noexcept;

}  // namespace zonepack
