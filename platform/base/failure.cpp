// SPDX-License-Identifier: Apache-2.0
#include "platform/base/failure.hpp"

#include <cerrno>
#include <cstring>
#include <iostream>

namespace zonepack {

Failure cannot_write(const std::string& file, const Error& error) {
  std::string message = file + ": cannot be written: " + reason_text(error);
  if (error.code == ErrorCode::kIo && error.detail == ENXIO) {
    message += "; where it is a FIFO, nobody reads it: start its reader first";
  }
  return {error.code, std::move(message)};
}

void Failures::add(const Failure& failure) {
  if (none()) {
    all_ = failure;
  } else {
    all_.message += '\n' + failure.message;
  }
}

std::string reason_text(const Error& error) {
  if (error.code == ErrorCode::kIo && error.detail != 0) {
    return std::strerror(static_cast<int>(error.detail));
  }
  return to_string(error.code);
}

int report_failure(std::string_view program, const Failure& failure) {
  std::cerr << program << ": " << failure.message << '\n';
  return exit_code(failure);
}

int exit_code(const Failure& failure) noexcept { return failure.code == ErrorCode::kUsage ? 2 : 1; }

}  // namespace zonepack
