// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace zonepack::packer {

// Streams JSON, one object per line, in pieces of about a MiB.
//
// Numbers read back exactly: a double prints in the shortest form that restores all its bits (minus
// zero as -0.0), a float as the double of the same value; NaN and infinities as the strings "nan",
// "inf" and "-inf". U+FFFD replaces each byte of text that is not UTF-8.
//
// Memory: a piece, and the longest single value.
// Threads: one.
class JsonLines {
 public:
  using Sink = std::function<void(std::string_view)>;
  explicit JsonLines(Sink sink) : sink_(std::move(sink)) {}

  void begin_object() { open('{'); }
  void end_object() { close('}'); }
  void begin_array() { open('['); }
  void end_array() { close(']'); }
  void key(std::string_view name);

  void number(double value);
  void integer(std::int64_t value);
  void text(std::string_view value);
  void null();
  void base64(std::span<const std::byte> bytes);
  template <typename Range>
  void numbers(const Range& values) {
    begin_array();
    for (const auto value : values) number(value);
    end_array();
  }

  void end_line();
  // Passes on what is buffered; call it at the end.
  void flush();

 private:
  void separate();
  void open(char bracket);
  void close(char bracket);
  void quoted(std::string_view value);

  static constexpr std::size_t kPieceBytes = 1 << 20;
  Sink sink_;
  std::string waiting_;
  bool first_ = true;  // nothing precedes it in its object or array, or it follows its key
};

}  // namespace zonepack::packer
