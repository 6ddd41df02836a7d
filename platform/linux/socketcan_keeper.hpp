// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "platform/base/result.hpp"
#include "platform/can_bus.hpp"
#include "platform/realtime.hpp"
#include "platform/socketcan.hpp"
#include "platform/wakeup.hpp"

namespace zonepack {

// Keeps a reader supplied with a socket of the interface that bears a name now.
//
// Threads: start() by the owner; take_new() and lost() by the one reader, in real time: atomics
// only; link() and granted_buffer_bytes() by any.
class SocketCanKeeper {
 public:
  static constexpr int kNoSocket = -1;

  explicit SocketCanKeeper(const SocketCanSettings& settings) : settings_(settings) {}
  ~SocketCanKeeper();

  // Looks for the first time, then goes on in a thread; errors are SocketCanBus::open()'s.
  Result<void> start();

  // The socket to read from now on in place of `held`, or kNoSocket; nothing while it stays as it
  // is. The keeper closes the one held; the reader closes the last one it was given.
  std::optional<int> take_new(int held) noexcept;

  // The socket given last says that its interface is gone.
  void lost() noexcept { lost_.store(true); }

  CanLink link() const noexcept { return link_.load(); }
  std::uint32_t granted_buffer_bytes() const noexcept { return granted_.load(); }

 private:
  static constexpr int kNothing = -2;

  void run();
  Result<void> look();
  void close_returned() noexcept;

  SocketCanSettings settings_;
  int bound_index_ = 0;                  // of the socket offered last; 0: none
  std::atomic<int> offered_{kNothing};   // keeper to reader
  std::atomic<int> returned_{kNothing};  // reader to keeper, while it takes what was offered
  std::atomic<bool> lost_{false};
  std::atomic<CanLink> link_{CanLink::kAbsent};
  std::atomic<std::uint32_t> granted_{0};
  std::atomic<bool> stop_{false};
  Wakeup wakeup_;
  Thread thread_;
};

}  // namespace zonepack
