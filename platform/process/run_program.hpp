// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "platform/base/result.hpp"

namespace zonepack {

// Runs a program found on PATH, without a shell, and waits for it. `arguments[0]` is its name.
// The descriptors become its standard input and output; it shares our standard error. Returns the
// exit status, or 128 + number when a signal ended it. kNotFound: no such program; kIo: errno.
Result<int> run_program(const std::vector<std::string>& arguments, int stdin_fd, int stdout_fd);

}  // namespace zonepack
