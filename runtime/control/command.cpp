// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/command.hpp"

namespace zonepack {

const char* to_string(Command::Kind kind) noexcept {
  switch (kind) {
    case Command::Kind::kPin:
      return "pin";
    case Command::Kind::kUnpin:
      return "unpin";
    case Command::Kind::kFreeze:
      return "freeze";
    case Command::Kind::kUnfreeze:
      return "unfreeze";
    case Command::Kind::kLease:
      return "lease";
    case Command::Kind::kRelease:
      return "release";
    case Command::Kind::kMapFreed:
      return "map_freed";
    case Command::Kind::kRouteHint:
      return "route_hint";
    case Command::Kind::kLost:
      return "lost";
    case Command::Kind::kSeek:
      return "seek";
    case Command::Kind::kAskTurn:
      return "ask_turn";
  }
  return "unknown";
}

}  // namespace zonepack
