// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "platform/base/require.hpp"
#include "platform/process/notify.hpp"

namespace zonepack::test_support {

// A service manager that keeps the files sent to it.
class ServiceManager {
 public:
  explicit ServiceManager(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.c_str(), path.size() + 1);
    ZP_REQUIRE(bind(socket_.get(), reinterpret_cast<sockaddr*>(&name), sizeof name) == 0);
    setenv("NOTIFY_SOCKET", path.c_str(), 1);
    notifier = Notifier::from_environment().value();
    unsetenv("NOTIFY_SOCKET");
  }

  // The files that it would pass to a zoned started now.
  std::vector<HandedFile> hand_over() {
    char text[256];
    for (;;) {
      iovec part{text, sizeof text};
      alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
      msghdr message{};
      message.msg_iov = &part, message.msg_iovlen = 1;
      message.msg_control = control, message.msg_controllen = sizeof control;
      const ssize_t size = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
      if (size < 0) break;
      const std::string said(text, static_cast<std::size_t>(size));
      const std::string name = said.substr(said.find("FDNAME=") + 7);
      if (said.starts_with("FDSTORE=1")) {
        int number = -1;
        std::memcpy(&number, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof number);
        kept_.push_back({name, Descriptor(number)});
      } else {
        std::erase_if(kept_, [&](const HandedFile& file) { return file.name == name; });
      }
    }
    std::vector<HandedFile> shares;
    for (const HandedFile& file : kept_) {
      shares.push_back({file.name, file.file.share().value()});
    }
    return shares;
  }

  Notifier notifier;

 private:
  Descriptor socket_;
  std::vector<HandedFile> kept_;
};

}  // namespace zonepack::test_support
