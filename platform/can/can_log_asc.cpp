// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_log_asc.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "platform/base/utf8.hpp"

namespace zonepack {
namespace {

using LineKind = CanLogLine::Kind;

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::string_view kBlanks = " \t\r";

// Takes words off the front of a line.
class Words {
 public:
  explicit Words(std::string_view text) noexcept : text_(text) {}

  std::string_view next() noexcept {
    text_.remove_prefix(std::min(text_.find_first_not_of(kBlanks), text_.size()));
    const std::string_view word = text_.substr(0, text_.find_first_of(kBlanks));
    text_.remove_prefix(word.size());
    return word;
  }

 private:
  std::string_view text_;
};

template <typename T>
bool to_number(std::string_view word, T& value, int base = 10) noexcept {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value, base);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

// Seconds with decimals.
bool to_stamp(std::string_view word, std::int64_t& ns) noexcept {
  const std::size_t point = word.find('.');
  std::int64_t seconds = 0;
  if (!to_number(word.substr(0, point), seconds) || seconds < 0 || seconds > 9'000'000'000) {
    return false;
  }
  std::int64_t unit = kNsPerSecond / 10;
  std::int64_t fraction = 0;
  if (point != std::string_view::npos) {
    for (const char c : word.substr(point + 1)) {
      if (c < '0' || c > '9') return false;
      fraction += (c - '0') * unit;
      unit /= 10;
    }
  }
  ns = seconds * kNsPerSecond + fraction;
  return true;
}

bool to_id(std::string_view word, bool decimal, CanFrame& frame) noexcept {
  frame.extended = word.ends_with('x') || word.ends_with('X');
  if (frame.extended) word.remove_suffix(1);
  return to_number(word, frame.id, decimal ? 10 : 16) &&
         frame.id <= (frame.extended ? 0x1FFFFFFFu : 0x7FFu);
}

// Months by their first letters, English and German, without what lies between m and z.
unsigned month_of(std::string_view word) noexcept {
  constexpr std::array<std::string_view, 12> kEnglish = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                         "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  for (unsigned i = 0; i < kEnglish.size(); ++i) {
    if (word.starts_with(kEnglish[i])) return i + 1;
  }
  if (word.starts_with("Mai")) return 5;
  if (word.starts_with("Okt")) return 10;
  if (word.starts_with("Dez")) return 12;
  return word.starts_with("M\xC3\xA4r") || word.starts_with("M\xE4r") || word.starts_with("Mrz")
             ? 3
             : 0;
}

// Days from 1970-01-01. Source: Hinnant, "chrono-compatible low-level date algorithms".
std::int64_t days_since_1970(std::int64_t year, unsigned month, unsigned day) noexcept {
  year -= month <= 2 ? 1 : 0;
  const std::int64_t era = year / 400;
  const std::int64_t of_era = year - era * 400;
  const unsigned of_year = (153 * (month > 2 ? month - 3 : month + 9) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

}  // namespace

bool CanAscLines::begins_with(std::string_view line) noexcept {
  line = without_byte_order_mark(line);
  return line.starts_with("date ") || line.starts_with("base hex") || line.starts_with("base dec");
}

// date Sat Jan 24 03:09:15.88 pm 2026
void CanAscLines::read_date(std::string_view line) noexcept {
  Words words(line);
  words.next();
  words.next();
  const unsigned month = month_of(words.next());
  unsigned day = 0, hour = 0, minute = 0;
  std::int64_t year = 0, second_ns = 0;
  if (!to_number(words.next(), day)) return;
  const std::string_view time = words.next();
  std::string_view last = words.next();
  const bool pm = last == "pm" || last == "PM";
  const bool am = last == "am" || last == "AM";
  if (pm || am) last = words.next();
  if (time.size() < 8 || !to_number(time.substr(0, 2), hour) ||
      !to_number(time.substr(3, 2), minute) || !to_stamp(time.substr(6), second_ns) ||
      !to_number(last, year) || month == 0 || day < 1 || day > 31 || hour > 23 || minute > 59 ||
      year < 1970 || year > 2200) {
    return;
  }
  if (pm && hour < 12) hour += 12;
  if (am && hour == 12) hour = 0;
  const std::int64_t seconds = days_since_1970(year, month, day) * 86400 +
                               std::int64_t{hour} * 3600 + std::int64_t{minute} * 60;
  start_ns_ = seconds * kNsPerSecond + second_ns;
}

CanLogLine CanAscLines::parse(std::string_view line) noexcept {
  line = without_byte_order_mark(line);
  Words words(line);
  const std::string_view first = words.next();
  if (first == "date") {
    read_date(line);
    return {};
  }
  if (first == "base") {
    decimal_ = words.next() == "dec";
    words.next();  // timestamps
    differences_ = words.next() == "relative";
    return {};
  }
  std::int64_t stamp_ns = 0;
  if (!to_stamp(first, stamp_ns)) return {};  // a remark, a section's begin or end
  latest_ns_ = differences_ ? latest_ns_ + stamp_ns : stamp_ns;
  CanLogLine read = parse_event(line);
  read.frame.stamp_ns = start_ns_ + latest_ns_;
  return read;
}

CanLogLine CanAscLines::parse_event(std::string_view text) noexcept {
  CanLogLine line;
  Words words(text);
  words.next();  // the stamp
  std::string_view channel = words.next();
  const bool fd = channel == "CANFD";
  if (fd) channel = words.next();
  unsigned number = 0;
  if (!to_number(channel, number) || number < 1 || number > 255) return line;
  std::string_view id = words.next();
  if (fd) id = words.next();  // after Rx or Tx
  CanFrame& frame = line.frame;
  const int used =
      std::snprintf(interface_.data(), interface_.size(), "can%u", (number - 1) & 0xFFu);
  line.interface = {interface_.data(), static_cast<std::size_t>(used)};
  if (id == "ErrorFrame") {
    frame.error = true;
    line.kind = LineKind::kFrame;
    return line;
  }
  if (!to_id(id, decimal_, frame)) return line;  // a statistic or status of the bus
  line.kind = LineKind::kBroken;
  const std::string_view way = fd ? std::string_view("Rx") : words.next();
  if (way != "Rx" && way != "Tx" && way != "TxRq") {
    line.fault = "expected Rx or Tx after the id";
    return line;
  }
  if (way == "TxRq") return {};  // the request; the frame itself follows
  unsigned length = 0;
  if (fd) {
    // [name] BRS ESI DLC length: the name may be missing.
    std::string_view brs = words.next();
    if (brs != "0" && brs != "1") brs = words.next();
    const std::string_view esi = words.next();
    words.next();  // the DLC
    frame.fd = true;
    frame.flags = static_cast<std::uint8_t>((brs == "1" ? 1 : 0) | (esi == "1" ? 2 : 0));
    if (!to_number(words.next(), length) || length > 64) {
      line.fault = "expected a length of up to 64 bytes";
      return line;
    }
  } else {
    const std::string_view what = words.next();
    frame.rtr = what == "r";
    if (what != "d" && what != "r") {
      line.fault = "expected d (data) or r (remote request) after Rx or Tx";
      return line;
    }
    const std::string_view size = words.next();
    if (!to_number(size, length, 16) && !frame.rtr) {
      line.fault = "expected the number of data bytes";
      return line;
    }
    length = std::min(length, 8u);
  }
  frame.len = static_cast<std::uint8_t>(length);
  for (unsigned i = 0; i < length && !frame.rtr; ++i) {
    if (!to_number(words.next(), frame.data[i], decimal_ ? 10 : 16)) {
      line.fault = "fewer data bytes than the length says";
      return line;
    }
  }
  line.kind = LineKind::kFrame;
  return line;
}

const char* foreign_can_log(std::string_view line) noexcept {
  line = without_byte_order_mark(line);
  if (line.starts_with("***BUSMASTER")) {
    return "a BusMaster log; convert it with: awk '/^[0-9]/{split($1,t,\":\");n=substr($4,3);"
           "w=$5~/x/?8:3;printf \"(%d.%s00) can%d %s#\",t[1]*3600+t[2]*60+t[3],t[4],$3-1,"
           "substr(substr(\"00000000\",1,w) n,length(n)+1);"
           "for(i=7;i<7+$6;i++)printf \"%s\",$i;print \"\"}' FILE > NEW.log";
  }
  if (line.starts_with(";$FILEVERSION")) {
    return "a PCAN trace; convert it with: python3 -m can.logconvert FILE NEW.log (sudo apt "
           "install python3-can)";
  }
  if (!line.starts_with("Time Stamp,ID,Extended")) return nullptr;
  // Older versions of SavvyCAN have no column Dir.
  return line.find(",Dir,") != std::string_view::npos
             ? "a CSV file of SavvyCAN; convert it with: awk -F, 'NR>1{w=$3==\"true\"?8:3;printf "
               "\"(%.6f) can%d %s#\",$1/1e6,$5,substr(substr(\"00000000\",1,w) $2,length($2)+1);"
               "for(i=7;i<7+$6;i++)printf \"%s\",$i;print \"\"}' FILE > NEW.log"
             : "a CSV file of SavvyCAN; convert it with: awk -F, 'NR>1{w=$3==\"true\"?8:3;printf "
               "\"(%.6f) can%d %s#\",$1/1e6,$4,substr(substr(\"00000000\",1,w) $2,length($2)+1);"
               "for(i=6;i<6+$5;i++)printf \"%s\",$i;print \"\"}' FILE > NEW.log";
}

}  // namespace zonepack
