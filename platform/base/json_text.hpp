// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zonepack {

// A text as a JSON string with its quotes; bytes from 0x80 on are taken to be UTF-8.
std::string json_quoted(std::string_view text);

}  // namespace zonepack
