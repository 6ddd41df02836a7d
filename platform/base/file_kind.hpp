// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace zonepack {

// What a file is when its first bytes (kFileKindBytes are enough) show that it stands in for what
// was expected, and what to do: "a Git LFS pointer, not the file itself; run: git lfs pull". Empty
// for anything else.
inline constexpr std::size_t kFileKindBytes = 64;
std::string stand_in(std::string_view first_bytes);

// The same for a file; empty also when it cannot be read.
std::string stand_in_at(const std::string& path);

// A path as one word of a shell.
std::string shell_quoted(std::string_view path);

}  // namespace zonepack
