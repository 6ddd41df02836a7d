// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "platform/process/local_socket.hpp"
#include "platform/process/poller.hpp"

namespace zonepack {

// One client at the server: its remaining allowance, what waits to be sent, what it subscribed to.
//
// Bounds: the kernel holds at most kKernelBytes and one message for it, this object kMostWaiting
// bytes; a client that does not read is dropped() after kPatience_ns, or after kMostLost events in
// a row.
// Threads: one, the server's.
class Session {
 public:
  static constexpr std::size_t kKernelBytes = std::size_t{32} * 1024;
  static constexpr std::size_t kMostWaiting = std::size_t{32} * 1024;
  static constexpr std::uint64_t kMostLost = 4096;
  static constexpr std::int64_t kPatience_ns = 10'000'000'000;
  static constexpr std::int64_t kHelloWithin_ns = 5'000'000'000;

  // requests_per_s: what it may ask. A quarter of a second's worth is there from the start, and is
  // the most that is saved up.
  Session(LocalSocket socket, std::uint64_t key, bool looking_only, std::uint32_t requests_per_s,
          std::int64_t now_ns);

  void refill(std::int64_t now_ns) noexcept;
  bool may_ask() const noexcept { return tokens_ >= 1 && waiting_.empty() && !dropped_; }
  // Whether a request waits because the allowance is used up; true once for each such wait. Call
  // before refill().
  bool begins_to_wait() noexcept;
  void pay() noexcept { tokens_ -= 1; }

  // An answer: sent, or kept until there is room.
  void answer(std::span<const std::byte> message, std::span<const int> descriptors = {});
  void flush(std::int64_t now_ns);

  // A notice that is worthless later; false when there is no room for it now.
  bool offer(std::span<const std::byte> message);

  // `count` events in one message; if there is no room they are lost, and the client is told before
  // the next delivery.
  void offer_events(std::span<const std::byte> message, std::uint64_t count);

  // Counts events that never got here.
  void lose_events(std::uint64_t count) noexcept;

  // Checks its deadlines; call once a turn.
  void check(std::int64_t now_ns) noexcept;

  Poller::Interest interest() const noexcept;

  // Ends the session: the client has gone, or (was_late) is sent away for not keeping up.
  void drop() noexcept { dropped_ = true; }
  bool was_late() const noexcept { return late_; }
  bool dropped() const noexcept { return dropped_; }

  LocalSocket socket;
  const std::uint64_t key;
  const bool looking_only;
  bool greeted = false;
  bool wants_events = false;
  std::int64_t pose_period_ns = 0;  // 0: no poses
  std::int64_t next_pose_ns = 0;
  Poller::Interest registered = Poller::kReadable;  // at the poller
  std::uint64_t lost_events() const noexcept { return lost_in_all_; }

 private:
  void send_away() noexcept { dropped_ = late_ = true; }

  const std::int64_t since_ns_;
  const double per_s_;
  const double most_tokens_;
  double tokens_;
  bool waits_ = false;  // a request, for the allowance
  std::int64_t refilled_ns_ = 0;
  std::deque<std::vector<std::byte>> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::int64_t waiting_since_ns_ = 0;
  std::uint64_t lost_ = 0;  // since the last event that was delivered
  std::uint64_t lost_in_all_ = 0;
  bool dropped_ = false;
  bool late_ = false;
};

}  // namespace zonepack
