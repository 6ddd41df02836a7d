// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace zonepack {

// What takes the place of a file of our own: "a FIFO", "a symbolic link" and so on, for messages.
// Links are not followed. nullopt: a regular file, or nothing.
std::optional<std::string> not_a_regular_file(const std::string& path);

}  // namespace zonepack
