// SPDX-License-Identifier: Apache-2.0
#include "platform/process/poller.hpp"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace zonepack {
namespace {

constexpr std::uint32_t kWakeToken = 0xFFFFFFFF;
constexpr std::size_t kMostAtOnce = 64;

epoll_event event_for(std::uint32_t token, Poller::Interest interest) noexcept {
  epoll_event event{};
  if ((interest & Poller::kReadable) != 0) event.events |= EPOLLIN;
  if ((interest & Poller::kWritable) != 0) event.events |= EPOLLOUT;
  event.data.u32 = token;
  return event;
}

}  // namespace

Result<Poller> Poller::create() {
  Poller poller(Descriptor(::epoll_create1(EPOLL_CLOEXEC)),
                Descriptor(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)));
  if (!poller.epoll_.is_open() || !poller.event_.is_open()) return {ErrorCode::kIo, errno};
  if (const auto added = poller.add(poller.event_.get(), kWakeToken, kReadable); !added) {
    return added.error();
  }
  return poller;
}

Result<void> Poller::add(int fd, std::uint32_t token, Interest interest) noexcept {
  epoll_event event = event_for(token, interest);
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) != 0) return {ErrorCode::kIo, errno};
  return {};
}

Result<void> Poller::change(int fd, std::uint32_t token, Interest interest) noexcept {
  epoll_event event = event_for(token, interest);
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, fd, &event) != 0) return {ErrorCode::kIo, errno};
  return {};
}

std::span<const Poller::Ready> Poller::wait(std::span<Ready> out, int timeout_ms) noexcept {
  std::array<epoll_event, kMostAtOnce> events;
  const auto most = static_cast<int>(std::min(out.size(), events.size()));
  const int count = ::epoll_wait(epoll_.get(), events.data(), most, timeout_ms);
  std::size_t ready = 0;
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events[static_cast<std::size_t>(i)];
    if (event.data.u32 == kWakeToken) {
      std::uint64_t times = 0;
      [[maybe_unused]] const ssize_t got = ::read(event_.get(), &times, sizeof times);
      continue;
    }
    out[ready++] = {event.data.u32, (event.events & EPOLLIN) != 0, (event.events & EPOLLOUT) != 0,
                    (event.events & (EPOLLHUP | EPOLLERR)) != 0};
  }
  return out.first(ready);
}

void Poller::wake() const noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t put = ::write(event_.get(), &one, sizeof one);
}

}  // namespace zonepack
