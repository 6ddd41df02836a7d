// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "platform/descriptor.hpp"

namespace zonepack {

// What a service tells the manager that started it, by the datagrams of sd_notify(3), and the open
// files that the manager keeps for it while it is restarted (DescriptorStoreMax= in its unit).
// Without a manager every call succeeds and does nothing. Errors: kIo with errno.
// Threads: any; each call sends one datagram and never waits.
class Notifier {
 public:
  Notifier() = default;  // no manager
  // As NOTIFY_SOCKET and WATCHDOG_USEC say.
  static Result<Notifier> from_environment();

  bool has_manager() const noexcept { return socket_.is_open(); }

  Result<void> ready() const { return send("READY=1"); }
  Result<void> reloading() const;
  Result<void> stopping() const { return send("STOPPING=1"); }
  Result<void> alive() const { return send("WATCHDOG=1"); }
  // One line, shown by `systemctl status`.
  Result<void> status(std::string_view line) const;

  // alive() is to be called more often than this; zero: nobody watches.
  std::chrono::microseconds watchdog() const noexcept { return watchdog_; }

  // The manager keeps a share of the file, and hands it back under `name` at the next start.
  Result<void> keep(std::string_view name, const Descriptor& file) const;
  Result<void> forget(std::string_view name) const;

 private:
  Result<void> send(std::string_view text, int file = -1) const;

  Descriptor socket_;
  std::string address_;  // first byte 0: an abstract one
  std::chrono::microseconds watchdog_{0};
};

// An open file that the manager handed over at start.
struct HandedFile {
  std::string name;
  Descriptor file;
};

// All of them, as LISTEN_PID, LISTEN_FDS and LISTEN_FDNAMES say; call once, before other threads
// run. Takes the variables out of the environment, so that children do not take them for theirs.
std::vector<HandedFile> take_handed_files();

}  // namespace zonepack
