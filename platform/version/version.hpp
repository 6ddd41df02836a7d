// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace zonepack {

// The release, major.minor.patch: project() of the top CMakeLists.txt.
std::string_view version() noexcept;

// The first 12 digits of the commit that was built, with "-dirty" when tracked files differed from
// it; "unknown" outside a checkout.
std::string_view commit() noexcept;

struct FormatVersion {
  std::string_view name;
  unsigned major = 0;
  std::optional<unsigned> minor;
};

// What a program prints for --version, with the formats that it reads and writes:
// "zoned 0.1.0 (commit 1a2b3c4d5e6f, pack format 1.0, recording format 1.1)".
std::string version_line(std::string_view program, std::initializer_list<FormatVersion> formats);

}  // namespace zonepack
