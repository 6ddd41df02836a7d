// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/socketcan_keeper.hpp"

#include <cerrno>

#include "platform/linux/socketcan_socket.hpp"
#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kLook_ns = 100'000'000;

}  // namespace

SocketCanKeeper::~SocketCanKeeper() {
  stop_.store(true);
  wakeup_.post();
  thread_.join();
  close_returned();
  const Descriptor never_taken(offered_.load());
}

Result<void> SocketCanKeeper::start() {
  const auto looked = look();
  if (!settings_.wait_for_interface) {
    if (!looked) return looked.error();
    if (link_.load() == CanLink::kAbsent) return ErrorCode::kNotFound;
    if (link_.load() == CanLink::kDown) return {ErrorCode::kIo, ENETDOWN};
  }
  auto thread = Thread::start({.name = "zoned-can", .stack_bytes = std::size_t{64} * 1024}, true,
                              [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void SocketCanKeeper::run() {
  while (!stop_.load()) {
    wakeup_.wait_until(monotonic_ns() + kLook_ns);
    static_cast<void>(look());  // a failure now is retried
  }
}

Result<void> SocketCanKeeper::look() {
  close_returned();
  const auto state = look_at_interface(settings_.interface);
  if (!state) return state.error();
  link_.store(state->link);
  if (lost_.exchange(false)) bound_index_ = 0;
  if (state->index == bound_index_ || offered_.load(std::memory_order_acquire) != kNothing) {
    return {};
  }
  int fd = kNoSocket;
  if (state->index != 0) {
    auto opened = open_can_socket(settings_, state->index);
    if (!opened) return opened.error();
    granted_.store(receive_buffer_of(*opened));
    fd = opened->release();
  }
  bound_index_ = state->index;
  offered_.store(fd, std::memory_order_release);
  return {};
}

void SocketCanKeeper::close_returned() noexcept {
  const Descriptor closed(returned_.exchange(kNothing, std::memory_order_acquire));
}

std::optional<int> SocketCanKeeper::take_new(int held) noexcept {
  const int fd = offered_.load(std::memory_order_acquire);
  if (fd == kNothing) return std::nullopt;
  returned_.store(held, std::memory_order_release);
  offered_.store(kNothing, std::memory_order_release);
  return fd;
}

}  // namespace zonepack
