// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <string>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// The largest value read from a database: a matrix that does not compress, and some room.
inline constexpr std::uint64_t kLargestValueBytes = kLargestMatrixBytes + (std::uint64_t{1} << 20);
// The largest value of a table that holds no matrices or images: Node, Feature, Info.
inline constexpr std::uint64_t kLargestPlainValueBytes = std::uint64_t{1} << 20;

// Bounds what a database made by a stranger can make SQLite do: no view, trigger, virtual table or
// generated column runs, no statement takes more steps than a file of its size can need, and no
// value is read that is longer than the reader allows.
//
// Ownership: the connection refers to the guard, which must outlive it.
class SqliteGuard {
 public:
  explicit SqliteGuard(std::uint64_t file_bytes) noexcept;
  SqliteGuard(const SqliteGuard&) = delete;
  SqliteGuard& operator=(const SqliteGuard&) = delete;

  // Call once, after the connection's own pragmas: later ones are refused.
  void protect(sqlite3* handle);

  // A statement starts; it may take statement_limit() steps.
  void start_statement() noexcept { statement_steps_ = 0; }
  // From here on a longer value is an error (SQLITE_TOOBIG), found before it is read.
  void allow_values_of(std::uint64_t bytes) noexcept {
    if (bytes == value_limit_) return;
    value_limit_ = bytes;
    sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, static_cast<int>(bytes));
  }

  std::uint64_t statement_limit() const noexcept { return statement_limit_; }
  std::uint64_t connection_limit() const noexcept { return connection_limit_; }
  // Whether the connection as a whole, not only a statement, used up its steps.
  bool exhausted() const noexcept { return connection_steps_ > connection_limit_; }
  std::uint64_t value_limit() const noexcept { return value_limit_; }

 private:
  static int count_steps(void* guard) noexcept;

  sqlite3* handle_ = nullptr;
  std::uint64_t statement_limit_, connection_limit_;
  std::uint64_t statement_steps_ = 0, connection_steps_ = 0;
  std::uint64_t value_limit_ = 0;
};

// What kind of thing the schema has under a name, for a message: "a view", "a virtual table". Empty
// for an ordinary table, and where there is nothing of that name.
std::string kind_unless_table(const std::string& type, const std::string& sql);

}  // namespace zonepack::packer
