// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/format.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "platform/base/utf8.hpp"

namespace zonepack::report {
namespace {

// Advances of DejaVu Sans for U+0020..U+007E, in hundredths of the font size.
constexpr std::array<unsigned char, 95> kAdvances = {
    32, 40, 46, 84, 64, 95, 78, 27, 39,  39, 50, 84, 32, 36, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64,
    64, 64, 34, 34, 84, 84, 84, 53, 100, 68, 69, 70, 77, 63, 58, 77, 75, 29, 29, 66, 56, 86, 75, 79,
    60, 79, 69, 63, 61, 73, 68, 99, 69,  61, 69, 39, 34, 39, 84, 50, 50, 61, 63, 55, 63, 62, 35, 63,
    63, 28, 28, 58, 28, 97, 63, 61, 63,  63, 41, 52, 39, 63, 59, 82, 59, 59, 52, 64, 34, 64, 84};
constexpr double kOtherAdvance = 0.65;
constexpr double kBoldFactor = 1.12;
constexpr std::string_view kThinSpace = "\xE2\x80\x89";
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// Bytes of the character at the front; 0 when it is not UTF-8 or not allowed in XML.
std::size_t character_length(std::string_view text) noexcept {
  const bool not_a_character = text.starts_with("\xEF\xBF\xBE") || text.starts_with("\xEF\xBF\xBF");
  return not_a_character ? 0 : utf8_length(text);
}

}  // namespace

std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 400> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, decimals);
  return std::string(buffer.data(), error == std::errc() ? end : buffer.data());
}

std::string format_number(double value, int decimals) {
  std::string text = format_fixed(value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string format_count(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, kThinSpace);
  }
  return text;
}

std::string format_bytes(double bytes) {
  constexpr std::array kUnits = {"B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  std::size_t unit = 0;
  while (std::abs(bytes) >= 1024 && unit + 1 < kUnits.size()) {
    bytes /= 1024;
    ++unit;
  }
  const double size = std::abs(bytes);
  const int decimals = unit == 0 || size >= 100 ? 0 : size >= 10 ? 1 : 2;
  return format_number(bytes, decimals) + " " + kUnits[unit];
}

std::string format_seconds(double seconds) {
  if (!std::isfinite(seconds) || std::abs(seconds) < 120) return format_number(seconds, 1) + " s";
  const double minutes = std::floor(std::round(seconds) / 60);
  return format_number(minutes, 0) + " min " +
         format_number(std::round(seconds) - minutes * 60, 0) + " s";
}

std::string escape_xml(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) {
      escaped += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    switch (const char c = text[0]) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        if (length > 1 || static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') {
          escaped += text.substr(0, length);
        }
    }
    text.remove_prefix(length);
  }
  return escaped;
}

double text_width_em(std::string_view text, bool bold) noexcept {
  double width = 0;
  for (const char c : text) {
    if (continues_utf8(c)) continue;
    const bool known = c >= ' ' && c <= '~';
    width += known ? kAdvances[static_cast<std::size_t>(c - ' ')] / 100.0 : kOtherAdvance;
  }
  return bold ? width * kBoldFactor : width;
}

std::string shorten_text(std::string_view text, double width_em) {
  constexpr std::string_view kCut = "...";
  if (text_width_em(text) <= width_em) return std::string(text);
  std::size_t kept = 0;  // bytes, up to the start of a character
  for (std::size_t next = 1; next < text.size(); ++next) {
    if (continues_utf8(text[next])) continue;
    if (text_width_em(text.substr(0, next)) + text_width_em(kCut) > width_em) break;
    kept = next;
  }
  text = text.substr(0, kept);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return std::string(text).append(kCut);
}

std::vector<std::string> wrap_text(std::string_view text, double width_em) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t blank = text.find(' ');
    const std::string_view word = text.substr(0, blank);
    text.remove_prefix(blank == std::string_view::npos ? text.size() : blank + 1);
    if (word.empty()) continue;
    const bool fits =
        !lines.empty() &&
        text_width_em(lines.back()) + text_width_em(" ") + text_width_em(word) <= width_em;
    if (fits) {
      lines.back().append(" ").append(word);
    } else {
      lines.emplace_back(word);
    }
  }
  return lines;
}

}  // namespace zonepack::report
