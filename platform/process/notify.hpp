// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "platform/files/descriptor.hpp"

namespace zonepack {

// Sends a service's notifications to the manager that started it, as the datagrams of sd_notify(3),
// and the open files that the manager keeps for it across a restart (FileDescriptorStoreMax= in its
// unit). Without a manager every call succeeds and does nothing.
//
// Errors: kIo with errno.
// Real-time: each call sends one datagram and never waits.
// Threads: any.
class Notifier {
 public:
  Notifier() = default;  // no manager
  // Reads NOTIFY_SOCKET and WATCHDOG_USEC.
  static Result<Notifier> from_environment();

  bool has_manager() const noexcept { return socket_.is_open(); }

  Result<void> ready() const { return send("READY=1"); }
  Result<void> reloading() const;
  Result<void> stopping() const { return send("STOPPING=1"); }
  Result<void> alive() const { return send("WATCHDOG=1"); }
  // One line, shown by `systemctl status`.
  Result<void> status(std::string_view line) const;

  // alive() must be called more often than this; zero: the manager does not watch.
  std::chrono::microseconds watchdog() const noexcept { return watchdog_; }

  // Asks the manager to keep a share of the file and pass it back as `name` at the next start.
  Result<void> keep(std::string_view name, const Descriptor& file) const;
  Result<void> forget(std::string_view name) const;

 private:
  Result<void> send(std::string_view text, int file = -1) const;

  Descriptor socket_;
  std::string address_;  // first byte 0: an abstract address
  std::chrono::microseconds watchdog_{0};
};

// An open file that the manager passed at start.
struct HandedFile {
  std::string name;
  Descriptor file;
};

// Takes all of them, as LISTEN_PID, LISTEN_FDS and LISTEN_FDNAMES say, and removes these variables
// from the environment, so that child processes do not mistake them for their own.
//
// Threads: call once, before other threads run.
std::vector<HandedFile> take_handed_files();

}  // namespace zonepack
