// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/failure.hpp"

namespace zonepack {

// Writes one whole text to a file, which it replaces by rename, or to standard output: "-".
Outcome<void> write_output(const std::string& path, const std::string& text);

}  // namespace zonepack
