// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace zonepack {

// A word, number, text or sign of a DBC file. Points into the file's bytes.
struct DbcToken {
  enum class Kind : std::uint8_t {
    kEnd,
    kWord,      // letters, digits and _
    kNumber,    // without its sign: 12, 0.5, 1e-3
    kText,      // between two quotes, line ends included
    kOpenText,  // a quote that is never closed
    kSign,      // any other byte
  };
  Kind kind = Kind::kEnd;
  std::string_view text;  // without quotes
  double number = 0;
  std::uint32_t line = 1;  // both count from 1; a column is a byte
  std::uint32_t column = 1;
  bool first_on_line = false;

  bool is(std::string_view word) const noexcept { return kind == Kind::kWord && text == word; }
  bool is_sign(char sign) const noexcept { return kind == Kind::kSign && text.front() == sign; }
};

// Cuts a DBC file into tokens. Accepts any bytes; \" within a text does not end it, as Vector's
// tools and others write it. Blanks, tabs, CR, LF, a byte order mark and comments (from // to the
// end of the line, outside of texts) separate tokens.
class DbcLexer {
 public:
  explicit DbcLexer(std::string_view bytes) noexcept;

  // The next token; at the end kEnd, every time.
  DbcToken next() noexcept;

 private:
  void skip_blanks() noexcept;
  void advance() noexcept;
  bool at_end() const noexcept { return at_ == bytes_.size(); }

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
  std::uint32_t column_ = 1;
  bool first_on_line_ = true;
};

}  // namespace zonepack
