// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace zonepack {

// Where a live run takes its frames from.
struct CanSourceChoice {
  enum class Kind { kSocketCan, kLog, kScript };
  Kind kind = Kind::kLog;
  std::string name;  // the interface, or the file
  double speed = 1;  // of a log or script: seconds of its time in a second
};

// "socketcan:can0", "log:FILE", "log:FILE@SPEED" or "sim:SCRIPT[@SPEED]"; nothing for other texts,
// and for speeds outside of 0.001 to 1000000. What stands after the last @ is the speed if it is a
// number, else part of the name.
std::optional<CanSourceChoice> parse_can_source(const std::string& text);

}  // namespace zonepack
