// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace zonepack {

// Bytes of the well-formed UTF-8 sequence (RFC 3629) at the front of the text; 0 when there is
// none, as in an empty text.
std::size_t utf8_length(std::string_view text) noexcept;

// Whether the whole text is well-formed UTF-8.
bool is_utf8(std::string_view text) noexcept;

// Whether the byte continues a sequence. Bytes that do not are as many as the code points.
constexpr bool continues_utf8(char c) noexcept {
  return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
}

// Code points of well-formed text: columns of a terminal, for most scripts.
std::size_t utf8_width(std::string_view text) noexcept;

// A text without the mark that editors of some systems put before its first line.
inline std::string_view without_byte_order_mark(std::string_view text) noexcept {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

}  // namespace zonepack
