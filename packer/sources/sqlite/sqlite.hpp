// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "packer/sources/sqlite/sqlite_guard.hpp"

namespace zonepack::packer {

// The file is not a database, or a part of it cannot be read. The message names the file and says
// what to do. Other parts of the file may still be readable.
class SqliteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A part of the file is not what SQLite or RTAB-Map writes: damaged pages, a value over its limit,
// a statement that does not end. problem() is the message without the file.
class SqliteCorrupt : public SqliteError {
 public:
  SqliteCorrupt(const std::string& file, const std::string& problem)
      : SqliteError(file + ": " + problem), problem_(problem) {}
  const std::string& problem() const noexcept { return problem_; }

 private:
  std::string problem_;
};

// What changes of a database file when a program commits to it.
struct FileState {
  std::uintmax_t size = 0;
  std::filesystem::file_time_type written{};
  std::string change_counter;  // bytes 24 to 27 of the file; SQLite counts commits there
  bool operator==(const FileState&) const = default;
};
FileState file_state(const std::filesystem::path& path);

// A SQLite database opened read-only and immutable: no byte, lock, journal or timestamp of it
// changes. SQLite therefore does not notice another program's writes; require_unchanged() does.
//
// Threads: one per object; another thread opens its own.
class SqliteFile {
 public:
  // Refuses anything but a whole, closed database: a missing or empty file, a folder, another kind
  // of file, one with a live write-ahead log or a hot journal next to it.
  explicit SqliteFile(const std::filesystem::path& path);

  // Throws SqliteError when the file was written since it was opened, or is being written. What was
  // read until then may mix several states.
  void require_unchanged() const;

  const std::string& name() const noexcept { return name_; }  // the path as given
  sqlite3* handle() const noexcept { return handle_.get(); }

  // Lower-case column names of a table; empty when there is no such table. Refuses a view or a
  // virtual table of that name.
  std::vector<std::string> columns(const std::string& table) const;

  SqliteGuard& guard() const noexcept { return *guard_; }

 private:
  void refuse_unless_table(const std::string& table) const;

  struct Close {
    void operator()(sqlite3* handle) const noexcept { sqlite3_close_v2(handle); }
  };
  std::string name_;
  std::filesystem::path file_;  // without links
  FileState state_;
  std::unique_ptr<SqliteGuard> guard_;  // outlives the connection
  std::unique_ptr<sqlite3, Close> handle_;
};

// A prepared statement. Columns are read by position, in place: a blob or text view is valid until
// the next step(), restart() or destruction.
class SqliteQuery {
 public:
  // A row with a value of more than `most_value_bytes` throws SqliteCorrupt before it is read.
  SqliteQuery(const SqliteFile& file, const std::string& sql,
              std::uint64_t most_value_bytes = kLargestPlainValueBytes);

  // Starts over with the given values for ?1, ?2.
  void restart();
  void restart(std::int64_t first);
  void restart(std::int64_t first, std::int64_t second);

  // The next row; false when there is none. Throws SqliteError where the file cannot be read.
  bool step() {
    file_->guard().allow_values_of(most_value_bytes_);
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    fail();
  }

  int type(int column) const { return sqlite3_column_type(statement_.get(), column); }
  bool is_null(int column) const { return type(column) == SQLITE_NULL; }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double real(int column) const { return sqlite3_column_double(statement_.get(), column); }
  std::string_view text(int column) const;
  std::span<const std::byte> blob(int column) const {
    const void* const data = sqlite3_column_blob(statement_.get(), column);
    const int size = data != nullptr ? sqlite3_column_bytes(statement_.get(), column) : 0;
    return {static_cast<const std::byte*>(data), static_cast<std::size_t>(size)};
  }

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
  };
  [[noreturn]] void fail() const;

  const SqliteFile* file_;
  std::uint64_t most_value_bytes_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

}  // namespace zonepack::packer
