// SPDX-License-Identifier: Apache-2.0
#include "platform/files/file_kind.hpp"

#include <filesystem>
#include <system_error>

namespace zonepack {

std::optional<std::string> not_a_regular_file(const std::string& path) {
  using std::filesystem::file_type;
  std::error_code unknown;
  switch (std::filesystem::symlink_status(path, unknown).type()) {
    case file_type::none:
    case file_type::not_found:
    case file_type::regular:
    case file_type::unknown:
      return std::nullopt;
    case file_type::directory:
      return "a folder";
    case file_type::symlink:
      return "a symbolic link";
    case file_type::block:
    case file_type::character:
      return "a device";
    case file_type::fifo:
      return "a FIFO";
    case file_type::socket:
      return "a socket";
  }
  return "a file of another kind";
}

}  // namespace zonepack
