// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_log_line.hpp"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

using Kind = CanLogLine::Kind;

constexpr std::uint32_t kErrorFlag = 0x20000000u;
constexpr std::uint32_t kExtendedMask = 0x1FFFFFFFu;
constexpr std::uint32_t kStandardMask = 0x7FFu;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

int hex_digit(char c) noexcept {
  if (is_digit(c)) return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

// The rest of the line, consumed from the front.
class Cursor {
 public:
  explicit Cursor(std::string_view text) noexcept : text_(text) {}

  bool done() const noexcept { return text_.empty(); }
  char front() const noexcept { return text_.empty() ? '\0' : text_.front(); }
  char at(std::size_t i) const noexcept { return i < text_.size() ? text_[i] : '\0'; }
  std::string_view rest() const noexcept { return text_; }
  void skip(std::size_t n) noexcept { text_.remove_prefix(std::min(n, text_.size())); }

  void skip_blanks() noexcept {
    while (!done() && is_blank(front())) skip(1);
  }
  bool take(char c) noexcept {
    if (done() || front() != c) return false;
    skip(1);
    return true;
  }
  std::string_view word() noexcept {
    std::size_t n = 0;
    while (n < text_.size() && !is_blank(text_[n])) ++n;
    const std::string_view found = text_.substr(0, n);
    skip(n);
    return found;
  }
  // Digits in the given base; false when there are none or the value does not fit.
  template <typename T>
  bool number(T& value, int base = 10) noexcept {
    const auto [end, error] =
        std::from_chars(text_.data(), text_.data() + text_.size(), value, base);
    if (error != std::errc()) return false;
    skip(static_cast<std::size_t>(end - text_.data()));
    return true;
  }

 private:
  std::string_view text_;
};

// Days from 1970-01-01 to a date of the Gregorian calendar.
std::int64_t days_from_civil(std::int64_t year, unsigned month, unsigned day) noexcept {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = (year >= 0 ? year : year - 399) / 400;
  const auto year_of_era = static_cast<unsigned>(year - era * 400);
  const unsigned day_of_year = (153 * (month > 2 ? month - 3 : month + 9) + 2) / 5 + day - 1;
  const unsigned day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  return era * 146097 + static_cast<std::int64_t>(day_of_era) - 719468;
}

bool parse_date(Cursor& in, std::int64_t& seconds) noexcept {
  unsigned year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  const bool read = in.number(year) && in.take('-') && in.number(month) && in.take('-') &&
                    in.number(day) && in.take(' ') && in.number(hour) && in.take(':') &&
                    in.number(minute) && in.take(':') && in.number(second);
  if (!read || year < 1970 || year > 2200 || month < 1 || month > 12 || day < 1 || day > 31 ||
      hour > 23 || minute > 59 || second > 60) {
    return false;
  }
  seconds = days_from_civil(year, month, day) * 86400 + std::int64_t{hour} * 3600 +
            std::int64_t{minute} * 60 + second;
  return true;
}

// "(seconds.fraction)" or "(date time.fraction)".
bool parse_stamp(Cursor& in, CanLogLine& line) noexcept {
  if (!in.take('(') || !is_digit(in.front())) return false;
  std::int64_t seconds = 0;
  const std::size_t point = in.rest().find_first_of(".-)");
  if (point != std::string_view::npos && in.at(point) == '-') {
    if (!parse_date(in, seconds)) return false;
  } else {
    line.absolute_stamp = point >= 9;
    if (!in.number(seconds) || seconds >= INT64_MAX / kSecond_ns) return false;
  }
  if (!in.take('.')) return false;
  std::int64_t fraction = 0;
  std::int64_t unit = kSecond_ns;
  while (is_digit(in.front()) && unit > 1) {
    fraction = fraction * 10 + (in.front() - '0');
    unit /= 10;
    in.skip(1);
  }
  line.frame.stamp_ns = seconds * kSecond_ns + fraction * unit;
  return unit < kSecond_ns && in.take(')');
}

// 3 digits: standard; 8 digits: extended, or an error frame.
bool parse_id(std::string_view digits, CanFrame& frame) noexcept {
  Cursor in(digits);
  std::uint32_t id = 0;
  if ((digits.size() != 3 && digits.size() != 8) || !in.number(id, 16) || !in.done()) return false;
  frame.error = digits.size() == 8 && (id & kErrorFlag) != 0;
  frame.extended = digits.size() == 8 && !frame.error;
  if (frame.error) id &= ~kErrorFlag;
  frame.id = id;
  return id <= (digits.size() == 3 ? kStandardMask : kExtendedMask);
}

bool parse_byte(Cursor& in, std::uint8_t& byte) noexcept {
  const int high = hex_digit(in.at(0));
  const int low = hex_digit(in.at(1));
  if (high < 0 || low < 0) return false;
  byte = static_cast<std::uint8_t>(high * 16 + low);
  in.skip(2);
  return true;
}

// What follows the first '#': "R", "R8", "#<flags><data>" or data, with a raw DLC "_9".
const char* parse_log_data(std::string_view text, CanFrame& frame) noexcept {
  Cursor in(text);
  if (in.take('R') || in.take('r')) {
    frame.rtr = true;
    if (const int length = hex_digit(in.front()); !in.done() && length >= 0 && length <= 8) {
      frame.len = static_cast<std::uint8_t>(length);
      in.skip(1);
    }
  } else {
    if (in.take('#')) {
      const int flags = hex_digit(in.front());
      if (flags < 0) return "a flag digit must follow ##";
      frame.fd = true;
      frame.flags = static_cast<std::uint8_t>(flags);
      in.skip(1);
    }
    const std::size_t most = frame.fd ? 64 : 8;
    in.take('.');
    while (!in.done() && in.front() != '_') {
      if (frame.len == most) return frame.fd ? "more than 64 data bytes" : "more than 8 data bytes";
      if (!parse_byte(in, frame.data[frame.len])) return "data is not pairs of hex digits";
      ++frame.len;
      in.take('.');
    }
  }
  if (in.take('_')) {
    if (frame.len != 8 || hex_digit(in.front()) < 9) return "a raw DLC is 9 to F, after 8 bytes";
    in.skip(1);
  }
  return in.done() ? nullptr : "text after the frame";
}

const char* parse_log_frame(Cursor& in, CanLogLine& line) noexcept {
  const std::string_view frame = in.word();
  const std::size_t hash = frame.find('#');
  if (!parse_id(frame.substr(0, hash), line.frame)) {
    return "an id has 3 hex digits (up to 7FF) or 8 (up to 1FFFFFFF, or an error frame)";
  }
  if (const char* fault = parse_log_data(frame.substr(hash + 1), line.frame)) return fault;
  in.skip_blanks();
  if (const std::string_view way = in.word(); !way.empty() && way != "R" && way != "T") {
    return "text after the frame";
  }
  in.skip_blanks();
  return in.done() ? nullptr : "text after the frame";
}

// "[8]" of a classic frame, "[08]" of FD, "{9}" a raw DLC above 8.
bool parse_screen_length(Cursor& in, CanFrame& frame) noexcept {
  if (in.take('{')) {
    frame.len = 8;
    const bool dlc = hex_digit(in.front()) > 8;
    in.skip(1);
    return dlc && in.take('}');
  }
  if (!in.take('[')) return false;
  frame.fd = is_digit(in.at(0)) && is_digit(in.at(1));
  return in.number(frame.len) && frame.len <= (frame.fd ? 64 : 8) && in.take(']');
}

const char* parse_screen_data(Cursor& in, CanFrame& frame) noexcept {
  bool swapped = false;
  for (std::size_t i = 0; i < frame.len; ++i) {
    if (i > 0 && in.take('`')) swapped = true;
    in.skip_blanks();
    const std::string_view rest = in.rest();
    const std::size_t digits =
        std::min(rest.find_first_not_of("0123456789ABCDEFabcdef"), rest.size());
    if (digits == 8 && rest.substr(0, 8).find_first_not_of("01") == std::string_view::npos) {
      in.number(frame.data[i], 2);
    } else if (digits != 2 || !parse_byte(in, frame.data[i])) {
      return "fewer data bytes than the length in brackets";
    }
  }
  if (swapped) std::reverse(frame.data.begin(), frame.data.begin() + frame.len);
  const char next = in.front();
  return in.done() || is_blank(next) ? nullptr : "text after the frame";
}

const char* parse_screen_frame(Cursor& in, CanLogLine& line) noexcept {
  std::string_view id = in.word();
  if (id == "RX" || id == "TX") {
    in.skip_blanks();
    line.frame.flags = in.word() == "B" ? 1 : 0;
    in.skip_blanks();
    if (in.word() == "E") line.frame.flags |= 2;
    in.skip_blanks();
    id = in.word();
  }
  if (!parse_id(id, line.frame)) return "not a candump line";
  in.skip_blanks();
  if (!parse_screen_length(in, line.frame)) return "a length such as [8] must follow the id";
  in.skip_blanks();
  if (in.rest().starts_with("remote request")) {
    line.frame.rtr = true;
    return nullptr;
  }
  return parse_screen_data(in, line.frame);
}

// DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)
CanLogLine parse_drop(std::string_view text) noexcept {
  CanLogLine line;
  line.kind = Kind::kDrop;
  Cursor in(text);
  in.skip(text.find(':') + 1);
  in.skip_blanks();
  if (in.rest().starts_with("dropped")) in.word();
  in.skip_blanks();
  if (!in.number(line.dropped)) {
    line.kind = Kind::kBroken;
    line.fault = "DROPCOUNT without a count";
  }
  return line;
}

CanLogLine parse_plain(std::string_view text) noexcept {
  CanLogLine line;
  Cursor in(text);
  if (text.starts_with("DROPCOUNT")) return parse_drop(text);
  line.kind = Kind::kBroken;
  if (in.front() != '(') {
    line.fault = "no time stamp: record with candump -l or -L";
    return line;
  }
  if (!parse_stamp(in, line)) {
    line.fault = "a time stamp is (seconds.fraction) with 1 to 9 decimals";
    return line;
  }
  in.skip_blanks();
  line.interface = in.word();
  in.skip_blanks();
  if (in.done()) {
    line.fault = "the line ends before its frame";
    return line;
  }
  const std::string_view rest = in.rest();
  const bool log = rest.substr(0, rest.find(' ')).find('#') != std::string_view::npos;
  line.fault = log ? parse_log_frame(in, line) : parse_screen_frame(in, line);
  if (line.fault == nullptr) line.kind = Kind::kFrame;
  return line;
}

}  // namespace

CanLogLine parse_can_log_line(std::string_view line) noexcept {
  const bool indented = !line.empty() && line.front() == '\t';
  while (!line.empty() && (is_blank(line.back()) || line.back() == '\r')) line.remove_suffix(1);
  // Colours: "\x1b[31m" before the line, "\x1b[0m" after it.
  while (line.starts_with("\x1b["))
    line.remove_prefix(std::min(line.find('m'), line.size() - 1) + 1);
  if (const std::size_t escape = line.find('\x1b'); escape != std::string_view::npos) {
    line = line.substr(0, escape);
  }
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  if (line.empty() || indented || line.front() == '#' || line.front() == ';') return {};
  return parse_plain(line);
}

std::string_view write_can_log_line(const CanFrame& frame, std::string_view interface,
                                    std::span<char> line) noexcept {
  ZP_REQUIRE(line.size() >= kCanLogLineRoom + interface.size());
  const std::int64_t stamp_us = std::max<std::int64_t>(0, frame.stamp_ns / 1000);
  const bool long_id = frame.extended || frame.error;
  const int used =
      std::snprintf(line.data(), line.size(), "(%010" PRId64 ".%06" PRId64 ") %.*s %0*" PRIX32,
                    stamp_us / 1'000'000, stamp_us % 1'000'000, static_cast<int>(interface.size()),
                    interface.data(), long_id ? 8 : 3, frame.id | (frame.error ? kErrorFlag : 0u));
  char* out = line.data() + used;
  const auto put_digit = [&out](unsigned value) { *out++ = "0123456789ABCDEF"[value & 0xF]; };
  *out++ = '#';
  if (frame.fd) {
    *out++ = '#';
    put_digit(frame.flags);
  }
  if (frame.rtr) {
    *out++ = 'R';
    if (frame.len > 0) put_digit(frame.len);
  } else {
    for (std::size_t i = 0; i < frame.len; ++i) {
      put_digit(frame.data[i] >> 4u);
      put_digit(frame.data[i]);
    }
  }
  return {line.data(), static_cast<std::size_t>(out - line.data())};
}

}  // namespace zonepack
