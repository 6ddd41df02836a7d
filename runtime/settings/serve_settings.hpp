// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>

namespace zonepack {

// Who may talk to zoned, and how much. The modes of the socket files decide who: octal digits, as
// for chmod.
struct ServeSettings {
  std::string socket = "auto";  // socket_place.hpp resolves it; empty: none
  std::string mode = "0660";
  std::string group;           // of the sockets' files; empty: the process's
  std::string looking_socket;  // for requests that change nothing; empty: none
  std::string looking_mode = "0666";
  std::uint32_t clients = 64;          // at once, on both sockets
  std::uint32_t requests_per_s = 500;  // of each client; more wait
  double lease_s = 2;                  // how long a lease lasts
};

// "0660" as permission bits; nothing when it is not a mode.
inline std::optional<unsigned> socket_mode(const std::string& text) noexcept {
  unsigned mode = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), mode, 8);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || mode > 0777) {
    return std::nullopt;
  }
  return mode;
}

}  // namespace zonepack
