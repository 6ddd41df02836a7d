// SPDX-License-Identifier: Apache-2.0
#include "platform/process/local_socket.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr int kKind = SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK;
constexpr int kQueue = 64;

Error io_error() noexcept { return {ErrorCode::kIo, errno}; }

bool would_wait(int error) noexcept { return error == EAGAIN || error == EWOULDBLOCK; }

bool address_of(const std::string& path, sockaddr_un& address) noexcept {
  static_assert(sizeof address.sun_path == LocalListener::kMostPath + 1);
  if (path.empty() || path.size() > LocalListener::kMostPath) return false;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return true;
}

const sockaddr* generic(const sockaddr_un& address) noexcept {
  return reinterpret_cast<const sockaddr*>(&address);
}

// Removes a socket left by a process that has ended; false when the name must stay.
bool remove_stale(const std::string& path) noexcept {
  struct stat status;
  if (::lstat(path.c_str(), &status) != 0) return errno == ENOENT;
  if (!S_ISSOCK(status.st_mode)) return false;
  const Result<LocalSocket> listener = LocalSocket::connect(path);
  if (listener.ok() || listener.error().code != ErrorCode::kNotFound) return false;
  return ::unlink(path.c_str()) == 0;
}

}  // namespace

Result<LocalSocket> LocalSocket::connect(const std::string& path) {
  sockaddr_un address{};
  if (!address_of(path, address)) {
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(path.size())};
  }
  Descriptor fd(::socket(AF_UNIX, kKind, 0));
  if (!fd.is_open()) return io_error();
  if (::connect(fd.get(), generic(address), sizeof address) != 0) {
    if (errno == ENOENT || errno == ECONNREFUSED) return {ErrorCode::kNotFound, errno};
    if (would_wait(errno)) return {ErrorCode::kBusy, errno};
    return io_error();
  }
  return LocalSocket(std::move(fd));
}

Result<void> LocalSocket::send(std::span<const std::byte> message,
                               std::span<const int> descriptors) const noexcept {
  ZP_REQUIRE(descriptors.size() <= kMostDescriptors);
  iovec part{const_cast<std::byte*>(message.data()), message.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int) * kMostDescriptors)] = {};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (!descriptors.empty()) {
    header.msg_control = control;
    header.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* const rights = CMSG_FIRSTHDR(&header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(rights), descriptors.data(), descriptors.size_bytes());
  }
  for (;;) {
    const ssize_t sent = ::sendmsg(fd_.get(), &header, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) return {};
    if (errno == EINTR) continue;
    if (would_wait(errno) || errno == ENOBUFS) return {ErrorCode::kBusy, errno};
    if (errno == EPIPE || errno == ECONNRESET) return {ErrorCode::kCancelled, errno};
    return io_error();
  }
}

Result<LocalSocket::Received> LocalSocket::receive(std::span<std::byte> buffer) const noexcept {
  iovec part{buffer.data(), buffer.size()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int) * kMostDescriptors)] = {};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control;
  header.msg_controllen = sizeof control;
  ssize_t got = 0;
  bool reset = false;  // the peer closed with unread data: reported once, before what it had sent
  do {
    reset = got < 0 && errno == ECONNRESET;
    got = ::recvmsg(fd_.get(), &header, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  } while (got < 0 && (errno == EINTR || (errno == ECONNRESET && !reset)));
  Received received;
  if (got < 0) {
    if (would_wait(errno)) return {ErrorCode::kBusy, errno};
    if (errno == ECONNRESET) return received;
    return io_error();
  }
  received.bytes = static_cast<std::size_t>(got);
  received.cut = (header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) != 0;
  for (cmsghdr* part_of = CMSG_FIRSTHDR(&header); part_of != nullptr;
       part_of = CMSG_NXTHDR(&header, part_of)) {
    if (part_of->cmsg_level != SOL_SOCKET || part_of->cmsg_type != SCM_RIGHTS) continue;
    const std::size_t count = (part_of->cmsg_len - CMSG_LEN(0)) / sizeof(int);
    for (std::size_t i = 0; i < count; ++i) {
      int fd = -1;
      std::memcpy(&fd, CMSG_DATA(part_of) + i * sizeof fd, sizeof fd);
      Descriptor owned(fd);
      if (received.descriptor_count == kMostDescriptors) continue;
      received.descriptors[received.descriptor_count++] = std::move(owned);
    }
  }
  return received;
}

bool LocalSocket::has_message() const noexcept {
  char first = 0;
  return ::recv(fd_.get(), &first, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

Result<void> LocalSocket::limit_output(std::size_t bytes) const noexcept {
  const int size = static_cast<int>(bytes / 2);  // the kernel doubles it for its own needs
  if (::setsockopt(fd_.get(), SOL_SOCKET, SO_SNDBUF, &size, sizeof size) != 0) return io_error();
  return {};
}

bool LocalSocket::wait(bool to_send, int timeout_ms) const noexcept {
  pollfd entry{fd_.get(), static_cast<short>(to_send ? POLLOUT : POLLIN), 0};
  return ::poll(&entry, 1, timeout_ms) > 0;
}

PeerCredentials LocalSocket::peer() const noexcept {
  ucred credentials{};
  socklen_t size = sizeof credentials;
  if (::getsockopt(fd_.get(), SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return {};
  return {credentials.pid, credentials.uid, credentials.gid};
}

Result<LocalListener> LocalListener::listen(const std::string& path, unsigned mode,
                                            std::optional<std::uint32_t> group) {
  sockaddr_un address{};
  if (!address_of(path, address)) {
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(path.size())};
  }
  if (!remove_stale(path)) return {ErrorCode::kExists, errno};
  Descriptor fd(::socket(AF_UNIX, kKind, 0));
  if (!fd.is_open()) return io_error();
  // No process can connect before listen(), so the mode is set in time.
  if (::bind(fd.get(), generic(address), sizeof address) != 0) return io_error();
  LocalListener listener(std::move(fd), path);
  if (group && ::chown(path.c_str(), static_cast<uid_t>(-1), *group) != 0) return io_error();
  if (::chmod(path.c_str(), static_cast<mode_t>(mode)) != 0) return io_error();
  if (::listen(listener.fd(), kQueue) != 0) return io_error();
  return listener;
}

LocalListener& LocalListener::operator=(LocalListener&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(path_, other.path_);
  return *this;
}

LocalListener::~LocalListener() {
  if (!path_.empty()) ::unlink(path_.c_str());
}

Result<LocalSocket> LocalListener::accept() const noexcept {
  for (;;) {
    Descriptor fd(::accept4(fd_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (fd.is_open()) return LocalSocket(std::move(fd));
    if (errno == EINTR || errno == ECONNABORTED) continue;
    if (would_wait(errno)) return {ErrorCode::kBusy, errno};
    return io_error();
  }
}

}  // namespace zonepack
