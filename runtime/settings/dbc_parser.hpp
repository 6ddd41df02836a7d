// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/settings/dbc_cursor.hpp"
#include "runtime/settings/dbc_file.hpp"

namespace zonepack {

// Reads the statements of a DBC file. Work is linear in the file's size, except for looking up
// signals by name within their message.
class DbcParser {
 public:
  DbcParser(std::string_view text, std::string path);

  std::vector<DbcMessage> messages() && { return std::move(messages_); }
  DbcSlips slips() && { return std::move(in_).result(); }

 private:
  void statement();
  void read_statement();
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
  void long_name(std::string_view attribute);
  void apply_cycle_times();
  void apply_long_names();

  DbcMessage* message_with(std::uint64_t id);
  DbcSignal* signal_of(std::uint64_t id, std::string_view name);
  bool message_and_signal(std::uint64_t& id, std::string_view& name);

  DbcCursor in_;
  std::vector<DbcMessage> messages_;
  std::map<std::uint64_t, std::size_t> by_id_;  // indices of messages by id, flag included
  bool ignored_ = false;                        // signals that follow belong to no frame
  std::size_t signals_ = 0;
  double default_cycle_ms_ = 0;
  std::map<std::uint64_t, double> cycle_ms_;
  struct LongName {
    std::uint64_t id = 0;
    std::string signal;  // empty: of the message
    std::string name;
  };
  std::vector<LongName> long_names_;
};

}  // namespace zonepack
