// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iostream>
#include <string>

namespace zonepack {

// "zoned: message" on standard error, in one piece. Any thread but control.
inline void print_line(const std::string& message) { std::cerr << "zoned: " + message + "\n"; }

}  // namespace zonepack
