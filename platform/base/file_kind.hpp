// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace zonepack {

// What a file is when its first bytes (kFileKindBytes are enough) show that it stands in for what
// was expected, and what to do, with a command that can be typed: "compressed by gzip; run gunzip
// first: gunzip < 'map.db' > NEW". Empty for anything else.
inline constexpr std::size_t kFileKindBytes = 64;
std::string stand_in(std::string_view first_bytes, std::string_view path = {});

// The same for a file; empty also when it cannot be read.
std::string stand_in_at(const std::string& path);

// What a file is by its first bytes, for messages about a file in the place of another: the text of
// stand_in(), else "a SQLite database", "a pack of a map (*.zpk)" and so on. Empty when unknown.
std::string known_kind(std::string_view first_bytes, std::string_view path = {});

// What stands at a path where a file that begins with `magic` was expected: "is a folder", "is
// empty (0 bytes)", or "is " and its known_kind(). Empty when that says nothing: for the expected
// kind, an unknown kind and a missing file.
std::string misplaced_at(const std::string& path, std::string_view magic);

}  // namespace zonepack
