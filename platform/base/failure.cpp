// SPDX-License-Identifier: Apache-2.0
#include "platform/base/failure.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "platform/base/shell_word.hpp"

namespace zonepack {
namespace {

// Where to make the folder that a file lacks; empty when it is there.
std::string missing_folder(const std::string& file, const Error& error) {
  const bool not_found = error.code == ErrorCode::kNotFound ||
                         (error.code == ErrorCode::kIo && error.detail == ENOENT);
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code unknown;
  return not_found && !std::filesystem::exists(folder, unknown) ? folder.string() : "";
}

}  // namespace

Failure cannot_write(const std::string& file, const Error& error) {
  std::string message = file + ": cannot be written: ";
  const std::string folder = missing_folder(file, error);
  message += folder.empty() ? reason_text(error)
                            : "there is no folder " + folder + "; mkdir -p " + shell_word(folder);
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
