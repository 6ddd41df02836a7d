// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "platform/base/result.hpp"
#include "platform/can/can_bus.hpp"
#include "platform/can/socketcan.hpp"
#include "platform/process/realtime.hpp"
#include "platform/process/wakeup.hpp"

namespace zonepack {

// Keeps a reader supplied with a socket of the interface that has the given name now.
//
// Real-time: take_new() and lost() use atomics only.
// Threads: start() by the owner; take_new() and lost() by the one reader; link() and
// granted_buffer_bytes() by any.
class SocketCanKeeper {
 public:
  static constexpr int kNoSocket = -1;

  explicit SocketCanKeeper(const SocketCanSettings& settings) : settings_(settings) {}
  ~SocketCanKeeper();

  // Looks for the interface once, then continues on a thread of its own. Errors: those of
  // SocketCanBus::open().
  Result<void> start();

  // The socket that replaces `held` from now on, or kNoSocket; nothing while there is no change.
  // The keeper closes the replaced socket; the reader closes the last one it was given.
  std::optional<int> take_new(int held) noexcept;

  // Reports that the interface of the last socket is gone.
  void lost() noexcept { lost_.store(true); }

  CanLink link() const noexcept { return link_.load(); }
  std::uint32_t granted_buffer_bytes() const noexcept { return granted_.load(); }

 private:
  static constexpr int kNothing = -2;

  void run();
  Result<void> look();
  void close_returned() noexcept;

  SocketCanSettings settings_;
  int bound_index_ = 0;                  // of the socket last offered; 0: none
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
