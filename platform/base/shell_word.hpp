// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zonepack {

// A path as one word of a shell, for commands in messages: between quotes.
std::string shell_quoted(std::string_view path);

// The same, quoted only where a shell needs it.
std::string shell_word(std::string_view path);

}  // namespace zonepack
