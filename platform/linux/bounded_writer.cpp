// SPDX-License-Identifier: Apache-2.0
#include "platform/files/bounded_writer.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "platform/linux/last_error.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

std::int64_t ns(std::chrono::milliseconds time) noexcept {
  return std::chrono::nanoseconds(time).count();
}

}  // namespace

BoundedWriter::BoundedWriter(int descriptor, const std::atomic<bool>& cancelled,
                             Terms terms) noexcept
    : descriptor_(descriptor),
      cancelled_(cancelled),
      terms_(terms),
      flags_(::fcntl(descriptor, F_GETFL)),
      began_ns_(monotonic_ns()),
      moved_ns_(began_ns_) {
  if (flags_ >= 0) ::fcntl(descriptor_, F_SETFL, flags_ | O_NONBLOCK);
}

BoundedWriter::~BoundedWriter() {
  if (flags_ >= 0) ::fcntl(descriptor_, F_SETFL, flags_);
}

Result<void> BoundedWriter::write(std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    if (cancelled_.load(std::memory_order_relaxed)) return ErrorCode::kCancelled;
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    const std::int64_t now_ns = monotonic_ns();
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      moved_ns_ = now_ns;
      if (now_ns - began_ns_ <= ns(terms_.in_all)) continue;
    } else if (written == 0) {
      return {ErrorCode::kIo, EIO};
    } else if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
      return last_error();
    }
    if (bytes.empty()) break;
    if (now_ns - moved_ns_ > ns(terms_.idle) || now_ns - began_ns_ > ns(terms_.in_all)) {
      return {ErrorCode::kIo, ETIMEDOUT};
    }
    pollfd room{descriptor_, POLLOUT, 0};
    ::poll(&room, 1, static_cast<int>(kLook.count()));
  }
  return {};
}

}  // namespace zonepack
