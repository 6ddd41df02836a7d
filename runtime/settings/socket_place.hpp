// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "runtime/settings/serve_settings.hpp"

// Where zoned's socket is: of --socket, else of ZONED_SOCKET, else of serve.socket. An empty path
// means that there is none; "auto" means the usual place.
namespace zonepack {

inline constexpr const char* kSystemSocket = "/run/zoned/zoned.sock";

// $XDG_RUNTIME_DIR/zonepack/zoned.sock for a user other than root who has that variable, else
// kSystemSocket. The folder need not exist.
std::string usual_socket(bool superuser);
std::string usual_socket();  // of the user who runs this

// Where a zoned with these settings listens. chosen: of --socket.
std::string listening_socket(const std::optional<std::string>& chosen,
                             const ServeSettings& settings);

// Where a client that was given no place finds zoned: the user's own where there is one, else the
// system's.
std::string socket_to_ask();

}  // namespace zonepack
