// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/odometry/can_signals.hpp"

// DBC files: what the frames of a CAN bus hold, by names of messages and signals. Read at start;
// the control thread decodes with plain CanSignals.
// Source: Vector Informatik, "DBC File Format Documentation", version 01/2007; extended
// multiplexing as in Vector's application note AN-ION-1-0521.
namespace zonepack {

struct DbcSignal {
  static constexpr std::int32_t kNone = -1;

  std::string name;
  std::string long_name;  // over 32 characters; empty: it has none
  std::string slip;       // why the statement could not be read; empty: it could
  std::string unit;
  SignalBits bits;  // any numbers; checked when the signal is asked for
  SignalType type = SignalType::kUnsigned;
  double factor = 1;
  double offset = 0;
  double least = 0;  // of the value; both 0: not given. Not enforced
  double most = 0;
  bool multiplexer = false;               // M, or m1M
  bool multiplexed = false;               // m1
  std::int32_t selected_by = kNone;       // index in the message, from SG_MUL_VAL_
  std::vector<CanSignal::Values> values;  // of its multiplexer that select it
  std::uint32_t line = 0;
  std::uint32_t column = 0;
};

struct DbcMessage {
  std::string name;
  std::string long_name;
  std::uint32_t id = 0;  // without the flag
  bool extended = false;
  std::uint32_t bytes = 0;
  std::optional<double> cycle_s;  // GenMsgCycleTime, over 0
  std::vector<DbcSignal> signals;
  std::uint32_t line = 0;
};

// A signal ready to be read.
struct DbcFound {
  CanSignal signal;
  std::optional<double> cycle_s;  // of its message
  std::string unit;
};

class DbcFile {
 public:
  DbcFile() = default;
  DbcFile(std::string path, std::vector<DbcMessage> messages);

  const std::vector<DbcMessage>& messages() const noexcept { return messages_; }

  // The signal of "Message.Signal", or of "Message@0x123.Signal" where several messages have that
  // name; long names count too. Fails when there is none (kNotFound) or it cannot be read: it does
  // not fit its message, it is a float that is not 32 bits long, its line has a slip. The message
  // names the line.
  Outcome<DbcFound> find(std::string_view name) const;

 private:
  // Never null. `signal` tells messages of one name apart where only one holds it.
  Outcome<const DbcMessage*> find_message(std::string_view name, std::string_view signal) const;
  Outcome<const DbcSignal*> find_signal(const DbcMessage& message, std::string_view name) const;

  std::string path_;
  std::vector<DbcMessage> messages_;
};

struct LoadedDbc {
  static constexpr std::size_t kMostFaults = 20;

  DbcFile file;                     // meaningful only without faults
  std::vector<std::string> faults;  // "file:line:column: expected ..., found ..."
  std::vector<std::string> slips;   // the same, of statements that could be done without
  std::string text;                 // of the file, if it could be read
  bool ok() const noexcept { return faults.empty(); }
};

// Reads a DBC file. Statements that do not affect reading signals are skipped, and a slip costs its
// statement only, unless nothing could be read at all. Memory is bounded:
// at most kLargestDbc bytes, kMostDbcSignals signals. Throws only when memory runs out.
inline constexpr std::size_t kLargestDbc = std::size_t{4} << 20;
inline constexpr std::size_t kMostDbcSignals = 65536;
LoadedDbc load_dbc(const std::string& path);

// The same for a text; messages name `path`.
LoadedDbc parse_dbc(std::string_view text, const std::string& path);

}  // namespace zonepack
