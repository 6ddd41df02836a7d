// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/settings/dbc_lexer.hpp"

namespace zonepack {

// A place in a DBC file, which moves on as what is expected there is found. Each that is not found
// becomes a fault with line and column; then the cursor stands on the next line that begins with a
// statement's word, so that one fault is one message.
class DbcCursor {
 public:
  DbcCursor(std::string_view text, std::string path);

  bool ended() const;  // also after the most faults that are told
  const DbcToken& now() const { return now_; }
  const DbcToken& begin() const { return begin_; }  // the word of the statement being read
  bool at_statement() const;
  bool at_symbol() const;  // one of those that NS_ lists
  void advance();

  // Steps over a statement's first word.
  bool begin_statement();
  // To behind its semicolon, whatever stands before that.
  void skip_statement();
  bool end_statement() { return sign(';'); }

  // Each steps over what it names and fills `into`, or is a fault that says what was expected.
  bool sign(char wanted);
  bool word(std::string_view& into, const char* what);
  bool number(double& into, const char* what);
  bool whole(std::uint64_t& into, std::uint64_t most, const char* what);
  bool text(std::string_view& into, const char* what);
  bool fail(const std::string& expected);  // here; always false

  void add_fault(const DbcToken& at, const std::string& expected);  // and stays
  std::vector<std::string> faults() && { return std::move(faults_); }

 private:
  using Kind = DbcToken::Kind;

  void recover();

  std::string path_;
  DbcLexer lexer_;
  DbcToken now_, ahead_;
  DbcToken begin_;
  std::vector<std::string> faults_;
};

}  // namespace zonepack
