// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/socket_place.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "platform/memory/account.hpp"

namespace zonepack {
namespace {

constexpr const char* kUsual = "auto";

}  // namespace

std::string usual_socket(bool superuser) {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  if (superuser || folder == nullptr || *folder == '\0') return kSystemSocket;
  return std::string(folder) + "/zonepack/zoned.sock";
}

std::string usual_socket() { return usual_socket(is_superuser()); }

std::string listening_socket(const std::optional<std::string>& chosen,
                             const ServeSettings& settings) {
  std::string socket = settings.socket;
  if (const char* const given = std::getenv("ZONED_SOCKET")) socket = given;
  if (chosen) socket = *chosen;
  return socket == kUsual ? usual_socket() : socket;
}

std::string socket_to_ask() {
  std::string own = usual_socket();
  std::error_code unknown;
  // Without a socket at either place, the own one is what a zoned started now would make.
  return !std::filesystem::exists(own, unknown) && std::filesystem::exists(kSystemSocket, unknown)
             ? kSystemSocket
             : own;
}

}  // namespace zonepack
