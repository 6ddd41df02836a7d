// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/live/gpio/line_requests.hpp"
#include "runtime/run/figures/line_board.hpp"

// How outputs and inputs are opened alike. A `Line` holds its `request`, its `row` on the board,
// the opened `line` (null: it cannot be had) and `retry_ns`, when it is tried again.
namespace zonepack {

inline constexpr std::int64_t kTryLineAgain_ns = 1'000'000'000;

template <typename Line>
Result<void> open_line(GpioPort& port, Line& line) {
  auto opened = port.open(line.request.settings);
  line.row->working.store(opened.ok());
  if (!opened) return opened.error();
  line.line = std::move(opened).value();
  return {};
}

// Fails at the first line that cannot be opened; with allow_degraded such lines are returned as
// complete warnings.
template <typename Line>
Outcome<std::vector<std::string>> open_lines(GpioPort& port, std::vector<Line>& lines,
                                             bool allow_degraded) {
  std::vector<std::string> warnings;
  for (Line& line : lines) {
    const Result<void> opened = open_line(port, line);
    if (opened) continue;
    const std::string wrong =
        line_fault(port, line.request.name, line.request.settings.name, opened.error());
    if (!allow_degraded) {
      return failure(wrong + "; or go on without by --allow-degraded", opened.error().code);
    }
    warnings.push_back(wrong);
  }
  return warnings;
}

// Whether a line that could not be had, or failed, is open now. Tried at most once a second.
template <typename Line>
bool reopen_line(GpioPort& port, Line& line, std::int64_t now_ns) {
  if (now_ns < line.retry_ns) return false;
  line.retry_ns = now_ns + kTryLineAgain_ns;
  if (open_line(port, line)) return true;
  line.row->failures.fetch_add(1);
  return false;
}

}  // namespace zonepack
