// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/session.hpp"

#include <algorithm>
#include <utility>

#include "runtime/protocol/messages.hpp"

namespace zonepack {

Session::Session(LocalSocket socket_of_client, std::uint64_t key_of_client, bool looking,
                 std::uint32_t requests_per_s, std::int64_t now_ns)
    : socket(std::move(socket_of_client)),
      key(key_of_client),
      looking_only(looking),
      since_ns_(now_ns),
      per_s_(requests_per_s),
      most_tokens_(std::max(requests_per_s / 4.0, 1.0)),
      tokens_(most_tokens_),
      refilled_ns_(now_ns) {
  if (!socket.limit_output(kKernelBytes)) dropped_ = true;
}

void Session::refill(std::int64_t now_ns) noexcept {
  const double seconds = static_cast<double>(now_ns - refilled_ns_) * 1e-9;
  tokens_ = std::min(most_tokens_, tokens_ + seconds * per_s_);
  refilled_ns_ = now_ns;
}

bool Session::begins_to_wait() noexcept {
  if (tokens_ >= 1) return waits_ = false;
  if (waits_ || dropped_ || !socket.has_message()) return false;
  return waits_ = true;
}

void Session::answer(std::span<const std::byte> message, std::span<const int> descriptors) {
  if (dropped_) return;
  if (waiting_.empty()) {
    const Result<void> sent = socket.send(message, descriptors);
    if (sent) return;
    if (sent.error().code != ErrorCode::kBusy || !descriptors.empty()) return drop();
  }
  if (waiting_bytes_ + message.size() > kMostWaiting) return send_away();
  waiting_.emplace_back(message.begin(), message.end());
  waiting_bytes_ += message.size();
}

void Session::flush(std::int64_t now_ns) {
  while (!waiting_.empty() && !dropped_) {
    const Result<void> sent = socket.send(waiting_.front());
    if (!sent && sent.error().code == ErrorCode::kBusy) return;
    if (!sent) return drop();
    waiting_bytes_ -= waiting_.front().size();
    waiting_.pop_front();
    waiting_since_ns_ = now_ns;
  }
}

bool Session::offer(std::span<const std::byte> message) {
  if (dropped_ || !waiting_.empty()) return false;
  const Result<void> sent = socket.send(message);
  if (!sent && sent.error().code != ErrorCode::kBusy) drop();
  return sent.ok();
}

void Session::offer_events(std::span<const std::byte> message, std::uint64_t count) {
  if (lost_ > 0) {
    MessageBuilder builder;
    if (offer(builder.reply(0, wire::CreateLost(builder.builder(), lost_)))) lost_ = 0;
  }
  if (lost_ > 0 || !offer(message)) lose_events(count);
}

void Session::lose_events(std::uint64_t count) noexcept {
  lost_ += count;
  lost_in_all_ += count;
  if (lost_ > kMostLost) send_away();
}

void Session::check(std::int64_t now_ns) noexcept {
  if (waiting_.empty()) waiting_since_ns_ = now_ns;
  if (now_ns - waiting_since_ns_ > kPatience_ns) send_away();
  if (!greeted && now_ns - since_ns_ > kHelloWithin_ns) send_away();
}

Poller::Interest Session::interest() const noexcept {
  if (!waiting_.empty()) return Poller::kWritable;
  return may_ask() ? Poller::kReadable : Poller::kNothing;
}

}  // namespace zonepack
