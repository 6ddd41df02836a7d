// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "platform/can/can_bus.hpp"

namespace zonepack {

// What one line of a candump recording holds.
struct CanLogLine {
  enum class Kind : std::uint8_t {
    kFrame,
    kNothing,  // blank, a comment (# or ;), the indented text that candump -e adds
    kDrop,     // DROPCOUNT: the recorder lost frames
    kBroken,   // none of these; `fault` says why
  };
  Kind kind = Kind::kNothing;
  CanFrame frame;
  std::string_view interface;  // "can0"; points into the line
  bool absolute_stamp = true;  // false: seconds since an unknown time, as candump -tz and -td print
  std::uint64_t dropped = 0;   // kDrop: frames lost
  const char* fault = nullptr;  // kBroken: a static text
};

// Reads a line of any of candump's text formats (can-utils 2006 to 2024), without its line end:
//   log (-l, -L)   (1436509052.249713) can0 044#2A366C2BBA [R|T]
//   screen         (1436509052.249713)  can0  044   [5]  2A 36 6C 2B BA   '*6l+.'
// with stamps of 1 to 9 decimals, or as a date (-tA, taken as UTC); ids of 3 or 8 digits; data with
// or without dots; remote requests (#R, #R8), FD (##<flags>), error frames, raw DLC (_9 .. _F,
// {9}); screen lines also with -x, -a, -e, -i (binary), -S (swapped bytes) and colours.
CanLogLine parse_can_log_line(std::string_view line) noexcept;

// Writes the line that candump -l writes for the frame, without its line end, into `line`, which
// must hold kCanLogLineRoom bytes plus the interface's name. Returns the text written. Stamps are
// rounded down to microseconds.
inline constexpr std::size_t kCanLogLineRoom = 192;
std::string_view write_can_log_line(const CanFrame& frame, std::string_view interface,
                                    std::span<char> line) noexcept;

}  // namespace zonepack
