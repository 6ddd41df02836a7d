// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/settings/dbc_file.hpp"
#include "runtime/settings/dbc_lexer.hpp"

namespace zonepack {

// Reads the statements of a DBC file. After a fault it goes on with the next line that begins with
// a statement's word. Work is linear in the file's size but for looking up signals by name within
// their message.
class DbcParser {
 public:
  DbcParser(std::string_view text, std::string path);

  std::vector<DbcMessage> messages() && { return std::move(messages_); }
  std::vector<std::string> faults() && { return std::move(faults_); }

 private:
  using Kind = DbcToken::Kind;

  void statement();
  void symbols();
  void bit_timing();
  void nodes();
  void message();
  void signal();
  bool signal_head(DbcSignal& signal);
  bool signal_layout(DbcSignal& signal);
  bool signal_scale(DbcSignal& signal);
  void receivers();
  void value_type();
  void multiplex_values();
  void attribute();
  void attribute_default();
  void skip_statement();
  void apply_cycle_times();

  void advance();
  void add_fault(const DbcToken& at, const std::string& expected);
  bool fail(const std::string& expected);  // at now_; then recovers
  void recover();
  bool at_statement() const;
  bool sign(char wanted);
  bool word(std::string_view& into, const char* what);
  bool number(double& into, const char* what);
  bool whole(std::uint64_t& into, std::uint64_t most, const char* what);
  bool text(std::string_view& into, const char* what);
  bool end_statement();
  DbcMessage* message_with(std::uint64_t id);
  DbcSignal* signal_of(std::uint64_t id, std::string_view name);
  bool message_and_signal(std::uint64_t& id, std::string_view& name);

  std::string path_;
  DbcLexer lexer_;
  DbcToken now_, ahead_;
  DbcToken begin_;  // of the statement being read
  std::vector<DbcMessage> messages_;
  std::map<std::uint64_t, std::size_t> by_id_;  // of messages, flag included
  bool ignored_ = false;                        // signals that follow belong to no frame
  std::size_t signals_ = 0;
  double default_cycle_ms_ = 0;
  std::map<std::uint64_t, double> cycle_ms_;
  std::vector<std::string> faults_;
};

}  // namespace zonepack
