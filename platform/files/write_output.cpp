// SPDX-License-Identifier: Apache-2.0
#include "platform/files/write_output.hpp"

#include <iostream>

#include "platform/files/atomic_file.hpp"

namespace zonepack {

Outcome<void> write_output(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::cout << text << std::flush;
    if (!std::cout) return failure("standard output: cannot be written", ErrorCode::kIo);
    return {};
  }
  const auto written = write_file_atomically(path, text);
  return written ? Outcome<void>() : cannot_write(path, written.error());
}

}  // namespace zonepack
