// SPDX-License-Identifier: Apache-2.0
#include "platform/process/notify.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace zonepack {
namespace {

std::optional<std::uint64_t> number_in(const char* name) {
  const char* const text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  std::uint64_t value = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

bool is_for_this_process(const char* pid_name) {
  const auto pid = number_in(pid_name);
  return pid && *pid == static_cast<std::uint64_t>(::getpid());
}

}  // namespace

Result<Notifier> Notifier::from_environment() {
  Notifier notifier;
  const char* const address = std::getenv("NOTIFY_SOCKET");
  if (address == nullptr || *address == '\0') return notifier;
  notifier.address_ = address;
  if (notifier.address_[0] == '@') notifier.address_[0] = '\0';
  if (notifier.address_.size() >= sizeof(sockaddr_un::sun_path)) {
    return {ErrorCode::kIo, ENAMETOOLONG};
  }
  notifier.socket_ = Descriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!notifier.socket_.is_open()) return {ErrorCode::kIo, errno};
  const auto period = number_in("WATCHDOG_USEC");
  if (period && (std::getenv("WATCHDOG_PID") == nullptr || is_for_this_process("WATCHDOG_PID"))) {
    notifier.watchdog_ = std::chrono::microseconds(*period);
  }
  return notifier;
}

Result<void> Notifier::reloading() const {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const auto usec = static_cast<long long>(now.tv_sec) * 1'000'000 + now.tv_nsec / 1000;
  return send("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(usec));
}

Result<void> Notifier::status(std::string_view line) const {
  return send("STATUS=" + std::string(line.substr(0, line.find('\n'))));
}

Result<void> Notifier::keep(std::string_view name, const Descriptor& file) const {
  return send("FDSTORE=1\nFDNAME=" + std::string(name), file.get());
}

Result<void> Notifier::forget(std::string_view name) const {
  return send("FDSTOREREMOVE=1\nFDNAME=" + std::string(name));
}

Result<void> Notifier::send(std::string_view text, int file) const {
  if (!has_manager()) return {};
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::memcpy(to.sun_path, address_.data(), address_.size());
  iovec part{const_cast<char*>(text.data()), text.size()};
  msghdr message{};
  message.msg_name = &to;
  message.msg_namelen = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof file)] = {};
  if (file >= 0) {
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof file);
    std::memcpy(CMSG_DATA(header), &file, sizeof file);
  }
  if (::sendmsg(socket_.get(), &message, MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
    return {ErrorCode::kIo, errno};
  }
  return {};
}

std::vector<HandedFile> take_handed_files() {
  constexpr int kFirst = 3;  // SD_LISTEN_FDS_START
  constexpr std::uint64_t kMost = 256;
  std::vector<HandedFile> handed;
  const auto count = number_in("LISTEN_FDS");
  if (is_for_this_process("LISTEN_PID") && count && *count <= kMost) {
    const char* const names = std::getenv("LISTEN_FDNAMES");
    std::string_view left = names == nullptr ? "" : names;
    for (int i = 0; i < static_cast<int>(*count); ++i) {
      const std::size_t end = left.find(':');
      const std::string_view name = left.substr(0, end);
      left = end == std::string_view::npos ? std::string_view() : left.substr(end + 1);
      Descriptor file(kFirst + i);
      if (::fcntl(file.get(), F_SETFD, FD_CLOEXEC) != 0) {
        file.release();
        continue;
      }
      handed.push_back({std::string(name), std::move(file)});
    }
  }
  ::unsetenv("LISTEN_PID");
  ::unsetenv("LISTEN_FDS");
  ::unsetenv("LISTEN_FDNAMES");
  return handed;
}

}  // namespace zonepack
