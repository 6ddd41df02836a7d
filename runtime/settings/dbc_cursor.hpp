// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/settings/dbc_lexer.hpp"

namespace zonepack {

// What is wrong with a DBC file: "file:line:column: expected ..., found ...".
struct DbcSlips {
  std::vector<std::string> slips;   // each in a statement that can be done without
  std::vector<std::string> faults;  // the file cannot be used
};

// A position in a DBC file, which advances as the expected tokens are found. A missing one becomes
// a slip with line and column, and the cursor skips to the next line that begins with a
// statement's keyword, so that one mistake gives one message. A slip costs its statement only;
// what the whole file depends on is a fault.
class DbcCursor {
 public:
  DbcCursor(std::string_view text, std::string path);

  bool ended() const { return now_.kind == Kind::kEnd; }
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

  // Each consumes what it names and fills `into`, or adds a slip that says what was expected.
  bool sign(char wanted);
  bool word(std::string_view& into, const char* what);
  bool number(double& into, const char* what);
  bool whole(std::uint64_t& into, std::uint64_t most, const char* what);
  bool text(std::string_view& into, const char* what);
  // One end of a range, which nothing enforces: anything up to the next | or ] will do.
  void limit(double& into);
  bool fail(const std::string& expected);  // adds a slip at now(); always false

  void add_slip(const DbcToken& at, const std::string& expected);  // without moving on
  void add_fault(const DbcToken& at, const std::string& expected);
  // The newest slip becomes a fault.
  void condemn();
  std::size_t slips() const { return slip_count_; }
  const std::string& newest_slip() const { return newest_; }
  DbcSlips result() &&;

 private:
  using Kind = DbcToken::Kind;

  void recover();

  std::string message(const DbcToken& at, const std::string& expected) const;

  std::string path_;
  DbcLexer lexer_;
  DbcToken now_, ahead_;
  DbcToken begin_;
  DbcSlips found_;  // of each at most LoadedDbc::kMostFaults
  std::size_t slip_count_ = 0;
  std::string newest_;
};

}  // namespace zonepack
