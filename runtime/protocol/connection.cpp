// SPDX-License-Identifier: Apache-2.0
#include "runtime/protocol/connection.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "platform/process/clock.hpp"

namespace zonepack {
namespace {

// Milliseconds until `end_ns`, rounded up so that waiting makes progress.
int left_ms(std::int64_t end_ns) noexcept {
  const std::int64_t left = (end_ns - monotonic_ns() + 999'999) / 1'000'000;
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 3'600'000));
}

}  // namespace

Result<Connection> Connection::open(const std::string& path, const std::string& client,
                                    int timeout_ms) {
  Result<LocalSocket> socket = LocalSocket::connect(path);
  if (!socket) return socket.error();
  Connection connection(std::move(socket).value());
  connection.timeout_ms_ = timeout_ms;
  MessageBuilder message;
  const auto name =
      message.builder().CreateString(client.data(), std::min(client.size(), kMostNameBytes));
  const auto hello = wire::CreateHello(message.builder(), kProtocolVersion, name);
  const auto reply = connection.ask(message, hello);
  if (!reply) return reply.error();
  if ((*reply)->fault() == wire::Fault::TooMany) return {ErrorCode::kBusy, 0};
  const wire::Welcome* const welcome = (*reply)->body_as_Welcome();
  if (welcome == nullptr) {
    return (*reply)->fault() == wire::Fault::Version ? ErrorCode::kBadVersion
                                                     : ErrorCode::kBadStructure;
  }
  if (welcome->version() != kProtocolVersion) return {ErrorCode::kBadVersion, welcome->version()};
  connection.welcome_ = connection.buffer_;
  connection.descriptors_ = std::move(connection.received_.descriptors);
  return connection;
}

int Connection::descriptor(wire::FdKind kind) const noexcept {
  const auto* const kinds = welcome().descriptors();
  if (kinds == nullptr) return -1;
  for (flatbuffers::uoffset_t i = 0; i < kinds->size() && i < descriptors_.size(); ++i) {
    if (static_cast<wire::FdKind>(kinds->Get(i)) == kind) return descriptors_[i].get();
  }
  return -1;
}

Result<const wire::Reply*> Connection::exchange(std::span<const std::byte> request,
                                                std::span<const int> descriptors) {
  const std::int64_t end_ns = monotonic_ns() + std::int64_t{timeout_ms_} * 1'000'000;
  for (;;) {
    const Result<void> sent = socket_.send(request, descriptors);
    if (sent) break;
    // zoned may have said why before it hung up.
    if (sent.error().code == ErrorCode::kCancelled) break;
    if (sent.error().code != ErrorCode::kBusy) return sent.error();
    if (!socket_.wait(true, left_ms(end_ns)) && monotonic_ns() >= end_ns) return ErrorCode::kBusy;
  }
  for (;;) {
    const auto reply = receive(left_ms(end_ns));
    // A signal to this process ends the wait, not the answer.
    if (!reply && reply.error().code == ErrorCode::kBusy && monotonic_ns() < end_ns) continue;
    if (!reply) return reply.error();
    const std::uint64_t id = (*reply)->id();
    if (id == last_id_ || (id == 0 && (*reply)->fault() != wire::Fault::None)) return *reply;
    if (id == 0 && on_notice_) on_notice_(**reply);
  }
}

Result<bool> Connection::listen(int timeout_ms) {
  const auto reply = receive(timeout_ms);
  if (!reply) {
    if (reply.error().code == ErrorCode::kBusy) return false;
    return reply.error();
  }
  if ((*reply)->id() == 0 && on_notice_) on_notice_(**reply);
  return true;
}

Result<const wire::Reply*> Connection::receive(int timeout_ms) {
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(buffer_));
  if (!socket_.wait(false, timeout_ms)) return ErrorCode::kBusy;
  Result<LocalSocket::Received> got = socket_.receive(bytes);
  if (!got) return got.error();
  if (got->bytes == 0) return ErrorCode::kCancelled;
  if (got->cut) return ErrorCode::kTooLarge;
  received_ = std::move(got).value();
  return check_reply(bytes.first(received_.bytes));
}

}  // namespace zonepack
