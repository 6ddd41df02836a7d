// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/base/byte_count.hpp"

// Numbers and words as they appear in reports: the same text in every locale, so that equal reports
// have equal bytes.
namespace zonepack::report {

// At most `decimals` digits after the point, trailing zeros dropped; "-" when not finite.
std::string format_number(double value, int decimals);

// Exactly `decimals` digits after the point, for columns; "-" when not finite.
std::string format_fixed(double value, int decimals);

// 12345 -> "12 345", with thin spaces; for reading, not for scripts.
std::string format_count(std::uint64_t count);

// "512 B", "3.4 MiB": three significant digits.
std::string format_bytes(double bytes);

// "615 s" as "10 min 15 s"; below two minutes seconds with one decimal.
std::string format_seconds(double seconds);

// Safe inside XML text and attributes: & < > " ' escaped, control characters dropped, and bytes
// that are not UTF-8 replaced by U+FFFD.
std::string escape_xml(std::string_view text);

// Width in units of the font size, by the advances of DejaVu Sans (Verdana's are nearly the same).
double text_width_em(std::string_view text, bool bold = false) noexcept;

// The text, or as much of its start as fits, followed by "...".
std::string shorten_text(std::string_view text, double width_em);

// Lines no wider than `width_em`, broken at blanks only; a longer word gets a line of its own.
std::vector<std::string> wrap_text(std::string_view text, double width_em);

}  // namespace zonepack::report
