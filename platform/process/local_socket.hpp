// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "platform/base/result.hpp"
#include "platform/files/descriptor.hpp"

// Sockets between programs of one machine that carry whole messages and file descriptors
// (SOCK_SEQPACKET).
//
// Errors: kIo with errno; others are listed at each call.
// Threads: one at a time per object.
namespace zonepack {

// The process at the other end, as the kernel knew it when the connection was made.
struct PeerCredentials {
  std::int32_t pid = 0;
  std::uint32_t uid = 0;
  std::uint32_t gid = 0;
};

class LocalSocket {
 public:
  static constexpr std::size_t kMostDescriptors = 4;

  // The result of one receive(); bytes 0: the peer closed.
  struct Received {
    std::size_t bytes = 0;
    bool cut = false;  // the message was longer than the buffer; its end is lost
    std::array<Descriptor, kMostDescriptors> descriptors;
    std::size_t descriptor_count = 0;
  };

  // kNotFound: no such socket, or no process listens on it. kBusy: its queue is full.
  static Result<LocalSocket> connect(const std::string& path);

  LocalSocket() = default;
  explicit LocalSocket(Descriptor fd) noexcept : fd_(std::move(fd)) {}

  // Sends one message, whole or not at all, without waiting. kBusy: no room now; kCancelled: the
  // peer has closed.
  Result<void> send(std::span<const std::byte> message,
                    std::span<const int> descriptors = {}) const noexcept;

  // Takes the next message without waiting. kBusy: there is none.
  Result<Received> receive(std::span<std::byte> buffer) const noexcept;

  // Whether a message waits; false when the peer has only closed.
  bool has_message() const noexcept;

  // Limits how many bytes wait in the kernel for the peer to read, besides one message.
  Result<void> limit_output(std::size_t bytes) const noexcept;

  // Waits until something can be received or sent; false on timeout.
  bool wait(bool to_send, int timeout_ms) const noexcept;

  PeerCredentials peer() const noexcept;
  int fd() const noexcept { return fd_.get(); }
  bool is_open() const noexcept { return fd_.is_open(); }
  void close() noexcept { fd_.close(); }

 private:
  Descriptor fd_;
};

// A name in the file system that other programs connect to; its mode decides who may. The
// destructor removes it.
class LocalListener {
 public:
  static constexpr std::size_t kMostPath = 107;

  // kExists: another process listens there, or it is not a socket; a socket without a listener is
  // replaced. kTooLarge: the path is longer than kMostPath bytes.
  // group: the number of the file's group, where it is not the process's; kIo with EPERM when the
  // process may not give the file to it.
  static Result<LocalListener> listen(const std::string& path, unsigned mode,
                                      std::optional<std::uint32_t> group = std::nullopt);

  LocalListener(LocalListener&& other) noexcept
      : fd_(std::move(other.fd_)), path_(std::exchange(other.path_, {})) {}
  LocalListener& operator=(LocalListener&& other) noexcept;
  ~LocalListener();

  // kBusy: no connection is waiting.
  Result<LocalSocket> accept() const noexcept;

  int fd() const noexcept { return fd_.get(); }
  const std::string& path() const noexcept { return path_; }

 private:
  LocalListener(Descriptor fd, std::string path) : fd_(std::move(fd)), path_(std::move(path)) {}
  Descriptor fd_;
  std::string path_;
};

}  // namespace zonepack
