// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "platform/process/local_socket.hpp"
#include "runtime/protocol/messages.hpp"

namespace zonepack {

// A client's end of the socket: says hello, sends requests, waits for their replies, and passes on
// unsolicited notices.
// Errors: kNotFound (nobody listens), kCancelled (zoned closed), kBusy (no answer in time),
// kBadVersion (zoned speaks another version; detail), kBadStructure, kIo.
// Threads: one.
class Connection {
 public:
  // Called with every notice (id 0), which is valid during the call.
  using OnNotice = std::function<void(const wire::Reply&)>;

  static Result<Connection> open(const std::string& path, const std::string& client,
                                 int timeout_ms = 2000);

  // What zoned said about itself and its map.
  const wire::Welcome& welcome() const noexcept {
    return *flatbuffers::GetRoot<wire::Reply>(welcome_.data())->body_as_Welcome();
  }
  // The descriptor of that kind, which this object keeps; -1 when zoned gave none.
  int descriptor(wire::FdKind kind) const noexcept;

  void on_notice(OnNotice call) { on_notice_ = std::move(call); }

  // Sends a request and waits for its reply, valid until the next call. A reply with a fault is not
  // an error here.
  template <typename Body>
  Result<const wire::Reply*> ask(MessageBuilder& message, flatbuffers::Offset<Body> body,
                                 std::span<const int> descriptors = {},
                                 std::uint32_t map_serial = 0) {
    ++last_id_;
    return exchange(message.request(last_id_, body, map_serial), descriptors);
  }

  // Waits for a notice and passes it on; true when one came.
  Result<bool> listen(int timeout_ms);

  const LocalSocket& socket() const noexcept { return socket_; }
  int fd() const noexcept { return socket_.fd(); }
  void set_timeout_ms(int timeout_ms) noexcept { timeout_ms_ = timeout_ms; }

 private:
  explicit Connection(LocalSocket socket) : socket_(std::move(socket)) {}
  Result<const wire::Reply*> exchange(std::span<const std::byte> request,
                                      std::span<const int> descriptors);
  Result<const wire::Reply*> receive(int timeout_ms);

  LocalSocket socket_;
  int timeout_ms_ = 2000;
  std::uint64_t last_id_ = 0;
  std::vector<std::uint64_t> buffer_ =
      std::vector<std::uint64_t>(kMostMessageBytes / sizeof(std::uint64_t));
  std::vector<std::uint64_t> welcome_;
  LocalSocket::Received received_;
  std::array<Descriptor, LocalSocket::kMostDescriptors> descriptors_;
  OnNotice on_notice_;
};

}  // namespace zonepack
