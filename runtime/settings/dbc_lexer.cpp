// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_lexer.hpp"

#include <charconv>
#include <limits>

#include "platform/base/utf8.hpp"

namespace zonepack {
namespace {

using TokenKind = DbcToken::Kind;

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
bool is_letter(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_exponent(char c) noexcept { return c == 'e' || c == 'E'; }

// Length of the number or word at the start of the text; 0 when it starts with a sign.
std::size_t run_length(std::string_view text) noexcept {
  const bool number = is_digit(text[0]) || (text[0] == '.' && text.size() > 1 && is_digit(text[1]));
  if (!number && !is_letter(text[0])) return 0;
  std::size_t length = 0;
  for (; length < text.size(); ++length) {
    const char c = text[length];
    if (is_digit(c) || is_letter(c) || (number && c == '.')) continue;
    const bool exponent_sign = number && (c == '+' || c == '-') && is_exponent(text[length - 1]) &&
                               length + 1 < text.size() && is_digit(text[length + 1]);
    if (!exponent_sign) break;
  }
  return length;
}

// A number beyond double is infinite, one too small for it 0: j1939.dbc as canmatrix ships it has
// ranges of that kind.
double beyond_double(std::string_view text) noexcept {
  const bool small = text.find("e-") != std::string_view::npos ||
                     text.find("E-") != std::string_view::npos || text[0] == '.' ||
                     text.substr(0, text.find('.')).find_first_not_of('0') == text.npos;
  return small ? 0 : std::numeric_limits<double>::infinity();
}

bool read_dbc_number(std::string_view text, double& number) noexcept {
  if (is_letter(text[0])) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::result_out_of_range) number = beyond_double(text);
  return error != std::errc::invalid_argument && end == text.data() + text.size();
}

}  // namespace

DbcLexer::DbcLexer(std::string_view bytes) noexcept : bytes_(without_byte_order_mark(bytes)) {}

void DbcLexer::advance() noexcept {
  if (bytes_[at_++] == '\n') {
    ++line_;
    column_ = 1;
    first_on_line_ = true;
  } else {
    ++column_;
  }
}

void DbcLexer::skip_blanks() noexcept {
  while (!at_end()) {
    const char c = bytes_[at_];
    if (bytes_.substr(at_).starts_with("//")) {
      while (!at_end() && bytes_[at_] != '\n') advance();
    } else if (c == ' ' || (c >= '\t' && c <= '\r')) {
      advance();
    } else {
      return;
    }
  }
}

DbcToken DbcLexer::next() noexcept {
  skip_blanks();
  DbcToken token;
  token.line = line_;
  token.column = column_;
  token.first_on_line = first_on_line_;
  if (at_end()) return token;
  first_on_line_ = false;
  if (bytes_[at_] == '"') {
    advance();
    const std::size_t begin = at_;
    while (!at_end() && bytes_[at_] != '"') {
      const bool escaped = bytes_[at_] == '\\' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] == '"';
      advance();
      if (escaped) advance();
    }
    token.kind = at_end() ? TokenKind::kOpenText : TokenKind::kText;
    token.text = bytes_.substr(begin, at_ - begin);
    if (!at_end()) advance();
    first_on_line_ = false;
    return token;
  }
  const std::size_t length = run_length(bytes_.substr(at_));
  token.text = bytes_.substr(at_, length == 0 ? 1 : length);
  token.kind = length == 0                                 ? TokenKind::kSign
               : read_dbc_number(token.text, token.number) ? TokenKind::kNumber
                                                           : TokenKind::kWord;
  at_ += token.text.size();
  column_ += static_cast<std::uint32_t>(token.text.size());
  return token;
}

}  // namespace zonepack
