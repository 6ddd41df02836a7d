// SPDX-License-Identifier: Apache-2.0
#include "packer/export/json_lines.hpp"

#include <charconv>
#include <cmath>

#include "platform/base/base64.hpp"
#include "platform/base/utf8.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kLongestNumber = 32;

}  // namespace

void JsonLines::separate() {
  if (!first_) waiting_ += ',';
  first_ = false;
}

void JsonLines::open(char bracket) {
  separate();
  waiting_ += bracket;
  first_ = true;
}

void JsonLines::close(char bracket) {
  waiting_ += bracket;
  first_ = false;
}

void JsonLines::key(std::string_view name) {
  separate();
  quoted(name);
  waiting_ += ':';
  first_ = true;
}

void JsonLines::number(double value) {
  if (std::isnan(value)) return text("nan");
  if (std::isinf(value)) return text(value > 0 ? "inf" : "-inf");
  separate();
  if (value == 0 && std::signbit(value)) {
    waiting_ += "-0.0";
    return;
  }
  char digits[kLongestNumber];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  waiting_.append(digits, end);
}

void JsonLines::integer(std::int64_t value) {
  separate();
  char digits[kLongestNumber];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  waiting_.append(digits, end);
}

void JsonLines::text(std::string_view value) {
  separate();
  quoted(value);
}

void JsonLines::null() {
  separate();
  waiting_ += "null";
}

void JsonLines::quoted(std::string_view value) {
  constexpr char kHex[] = "0123456789abcdef";
  waiting_ += '"';
  for (std::size_t at = 0; at < value.size();) {
    const std::size_t length = utf8_length(value.substr(at));
    const char c = value[at];
    if (length == 0) {
      waiting_ += "\\ufffd";
    } else if (c == '"' || c == '\\') {
      waiting_ += '\\';
      waiting_ += c;
    } else if (length == 1 && static_cast<unsigned char>(c) < 0x20) {
      waiting_ += "\\u00";
      waiting_ += kHex[c >> 4];
      waiting_ += kHex[c & 15];
    } else {
      waiting_.append(value, at, length);
    }
    at += length == 0 ? 1 : length;
  }
  waiting_ += '"';
}

void JsonLines::base64(std::span<const std::byte> bytes) {
  separate();
  waiting_ += '"';
  append_base64(bytes, waiting_);
  waiting_ += '"';
}

void JsonLines::end_line() {
  waiting_ += '\n';
  first_ = true;
  if (waiting_.size() >= kPieceBytes) flush();
}

void JsonLines::flush() {
  sink_(waiting_);
  waiting_.clear();
}

}  // namespace zonepack::packer
