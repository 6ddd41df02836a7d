// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace zonepack {

inline constexpr const char* kRed = "\x1b[31m";
inline constexpr const char* kGreen = "\x1b[32m";
inline constexpr const char* kYellow = "\x1b[33m";
inline constexpr const char* kDim = "\x1b[2m";
inline constexpr const char* kBold = "\x1b[1m";

// One line that never grows wider than the terminal. A code point counts as one column.
class ScreenLine {
 public:
  ScreenLine(int columns, bool color) : columns_(columns), color_(color) {}

  ScreenLine& add(std::string_view words, const char* style = nullptr) {
    const bool styled = color_ && style != nullptr && width_ < columns_;
    if (styled) text_ += style;
    for (std::size_t i = 0; i < words.size();) {
      std::size_t end = i + 1;
      while (end < words.size() && (static_cast<unsigned char>(words[end]) & 0xC0) == 0x80) ++end;
      if (width_ < columns_) {
        // A name may hold anything; no control code of it reaches the terminal.
        const bool printable = static_cast<unsigned char>(words[i]) >= 0x20 && words[i] != 0x7F;
        text_ += printable ? std::string(words.substr(i, end - i)) : "?";
        ++width_;
      }
      i = end;
    }
    if (styled) text_ += "\x1b[0m";
    return *this;
  }
  ScreenLine& pad_to(int column) {
    while (width_ < std::min(column, columns_)) add(" ");
    return *this;
  }
  int left() const { return columns_ - width_; }
  std::string done() const { return text_ + "\n"; }

 private:
  int columns_;
  bool color_;
  int width_ = 0;
  std::string text_;
};

}  // namespace zonepack
