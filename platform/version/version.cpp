// SPDX-License-Identifier: Apache-2.0
#include "platform/version/version.hpp"

#include "platform/version/commit_generated.h"

namespace zonepack {

std::string_view version() noexcept { return ZONEPACK_VERSION; }

std::string_view commit() noexcept { return ZONEPACK_COMMIT; }

std::string version_line(std::string_view program, std::initializer_list<FormatVersion> formats) {
  std::string line(program);
  line.append(" ").append(version()).append(" (commit ").append(commit());
  for (const FormatVersion& format : formats) {
    line.append(", ").append(format.name).append(" ").append(std::to_string(format.major));
    if (format.minor) line.append(".").append(std::to_string(*format.minor));
  }
  return line.append(")");
}

}  // namespace zonepack
