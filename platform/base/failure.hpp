// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "platform/base/result.hpp"

namespace zonepack {

// Why something above the control path could not be done: a code for programs, and a complete
// message for people. It names the file, zone, key, line or pin, what was expected, and what to do
// next; it neither begins with the program's name nor ends with a line feed.
struct [[nodiscard]] Failure {
  ErrorCode code = ErrorCode::kOk;
  std::string message;
};

// A value, or the failure to show to the user.
//
// Real-time: messages allocate; the control thread returns Result<T> instead.
template <typename T>
using Outcome = Result<T, Failure>;

// What is wrong with the input or the world.
inline Failure failure(std::string message, ErrorCode code = ErrorCode::kBadValue) {
  return {code, std::move(message)};
}

// Several things that were tried, each of which may have failed alone.
class Failures {
 public:
  void add(const Outcome<void>& outcome) {
    if (!outcome) add(outcome.error());
  }
  void add(const Failure& failure);
  bool none() const noexcept { return all_.code == ErrorCode::kOk; }

  // All messages, one a line, with the first one's code; none: done.
  Outcome<void> all() const {
    if (none()) return {};
    return all_;
  }

 private:
  Failure all_;
};

// What is wrong with the command line.
inline Failure usage_failure(std::string message) {
  return {ErrorCode::kUsage, std::move(message)};
}

// "FILE: cannot be written: permission denied", with errno's text where there is one, and how to
// make a folder that is missing.
Failure cannot_write(const std::string& file, const Error& error);

// The error's word ("bad checksum"), or errno's text for kIo.
std::string reason_text(const Error& error);

// The exit code of a program that fails so: 2 for a wrong command line, else 1.
int exit_code(const Failure& failure) noexcept;

// Prints "PROGRAM: message" to standard error, and returns the exit code.
int report_failure(std::string_view program, const Failure& failure);

}  // namespace zonepack
