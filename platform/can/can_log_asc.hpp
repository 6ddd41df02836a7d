// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "platform/can/can_log_line.hpp"

namespace zonepack {

// Reads the lines of a Vector ASC file, which CANoe, CANalyzer, PCAN-Explorer and python-can write:
//   date Sat Jan 24 15:09:15.88 2026
//   base hex  timestamps absolute
//      0.015991 1  311             Rx   d 8 00 00 40 DB 00 01 5B CF
//      0.016200 CANFD 1 Rx 18DAF1x  ... 0 0 8 8 01 02 03 04 05 06 07 08 ...
// Stamps count from the date of the header, taken as UTC; channel 1 is can0. Events other than
// frames are nothing.
class CanAscLines {
 public:
  // Whether a file whose first line is this one is an ASC file.
  static bool begins_with(std::string_view first_line) noexcept;

  // The interface's name points into this object, until the next call.
  CanLogLine parse(std::string_view line) noexcept;

 private:
  CanLogLine parse_event(std::string_view line) noexcept;
  void read_date(std::string_view line) noexcept;

  std::int64_t start_ns_ = 0;
  std::int64_t latest_ns_ = 0;  // since the start
  bool decimal_ = false;        // base of ids and data
  bool differences_ = false;    // each stamp counts from the one before
  std::array<char, 8> interface_{};
};

// Names a log that is none of candump's or Vector's by its first line, with the command that
// converts it; null for any other text.
const char* foreign_can_log(std::string_view first_line) noexcept;

}  // namespace zonepack
