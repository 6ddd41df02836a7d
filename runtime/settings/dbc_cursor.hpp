// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/settings/dbc_lexer.hpp"

namespace zonepack {

// A position in a DBC file, which advances as the expected tokens are found. A missing one becomes
// a fault with line and column, and the cursor skips to the next line that begins with a
// statement's keyword, so that one mistake gives one message.
class DbcCursor {
 public:
  DbcCursor(std::string_view text, std::string path);

  bool ended() const;  // also once LoadedDbc::kMostFaults were found
  const DbcToken& now() const { return now_; }
  const DbcToken& begin() const { return begin_; }  // the keyword of the statement being read
  bool at_statement() const;
  bool at_symbol() const;  // one of the symbols that NS_ lists
  void advance();

  // Skips a statement's keyword.
  bool begin_statement();
  // Skips past the statement's semicolon, whatever comes before it.
  void skip_statement();
  bool end_statement() { return sign(';'); }

  // Each consumes what it names and fills `into`, or adds a fault that says what was expected.
  bool sign(char wanted);
  bool word(std::string_view& into, const char* what);
  bool number(double& into, const char* what);
  bool whole(std::uint64_t& into, std::uint64_t most, const char* what);
  bool text(std::string_view& into, const char* what);
  bool fail(const std::string& expected);  // adds a fault at now(); always false

  void add_fault(const DbcToken& at, const std::string& expected);  // without moving on
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
