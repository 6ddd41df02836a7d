// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/sqlite/sqlite.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <system_error>

#include "platform/base/file_kind.hpp"
#include "platform/base/shell_word.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDatabaseMagic("SQLite format 3\0", 16);

std::string first_bytes(const fs::path& path, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

fs::path with_suffix(const fs::path& path, const char* suffix) {
  fs::path other = path;
  other += suffix;
  return other;
}

void refuse_unless_database(const fs::path& path, const std::string& name) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw SqliteError(name + ": no such file; expected an RTAB-Map database");
  }
  if (error) throw SqliteError(name + ": " + error.message());
  if (fs::is_directory(status)) {
    throw SqliteError(name + ": is a folder, expected a database file, such as map.db");
  }
  if (!fs::is_regular_file(status)) {
    throw SqliteError(name + ": is not a regular file, expected a database file");
  }
  if (fs::file_size(path, error) == 0 && !error) {
    throw SqliteError(name + ": is empty (0 bytes), expected a database file");
  }
  if (!std::ifstream(path, std::ios::binary)) {
    throw SqliteError(name + ": cannot be read: " + std::strerror(errno));
  }
  const std::string first = first_bytes(path, kFileKindBytes);
  if (const std::string kind = stand_in(first, name); !kind.empty()) {
    throw SqliteError(name + ": is " + kind + "; expected a SQLite database");
  }
  if (!first.starts_with(kDatabaseMagic)) {
    if (const std::string kind = known_kind(first, name); !kind.empty()) {
      throw SqliteError(name + ": is " + kind + "; expected a SQLite database");
    }
    throw SqliteError(
        name +
        ": is not a SQLite database (its first 16 bytes are not those of one), and no "
        "other map that is read");
  }
}

void refuse_if_not_closed(const fs::path& path, const std::string& name) {
  std::error_code error;
  const fs::path wal = with_suffix(path, "-wal");
  if (const auto size = fs::file_size(wal, error); !error && size > 0) {
    throw SqliteError(name + ": has changes that are not in the file yet (" + wal.string() +
                      "); close RTAB-Map, or run: sqlite3 " + shell_quoted(name) +
                      " 'PRAGMA wal_checkpoint(TRUNCATE)'");
  }
  const fs::path journal = with_suffix(path, "-journal");
  // SQLite's own rule: a journal whose first byte is not zero is unfinished.
  const std::string first = first_bytes(journal, 1);
  if (!first.empty() && first[0] != '\0') {
    throw SqliteError(name + ": a write to it was interrupted (" + journal.string() +
                      "); close RTAB-Map, or let SQLite restore it: sqlite3 " + shell_quoted(name) +
                      " 'PRAGMA schema_version'");
  }
}

std::string immutable_uri(const fs::path& absolute_path) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : absolute_path.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::strchr("/-._~", c) != nullptr) {
      uri += c;
    } else {
      uri += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return uri + "?mode=ro&immutable=1";
}

}  // namespace

FileState file_state(const fs::path& path) {
  FileState state;
  std::error_code error;
  state.size = fs::file_size(path, error);
  state.written = fs::last_write_time(path, error);
  const std::string header = first_bytes(path, 28);
  if (header.size() == 28) state.change_counter = header.substr(24);
  return state;
}

SqliteFile::SqliteFile(const fs::path& path) : name_(path.string()) {
  refuse_unless_database(path, name_);
  // SQLite keeps its log and journal next to the file itself, not next to a link to it.
  const fs::path file = fs::canonical(path);
  // Before the look for a journal: a commit that begins in between changes the state.
  state_ = file_state(file);
  file_ = file;
  refuse_if_not_closed(file, name_);
  sqlite3* handle = nullptr;
  std::error_code no_size;
  const std::uintmax_t size = fs::file_size(file, no_size);
  guard_ = std::make_unique<SqliteGuard>(no_size ? 0 : size);
  const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX;
  const int code = sqlite3_open_v2(immutable_uri(file).c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) {
    throw SqliteError(name_ + ": cannot be opened: " + sqlite3_errstr(code));
  }
  // The file's header may ask for a cache of any size.
  sqlite3_exec(handle, "PRAGMA cell_size_check=ON; PRAGMA cache_size=-2000", nullptr, nullptr,
               nullptr);
  guard_->protect(handle);
}

void SqliteFile::refuse_unless_table(const std::string& table) const {
  SqliteQuery query(*this, "SELECT type, sql FROM sqlite_master WHERE lower(name)=lower('" + table +
                               "') AND type<>'index' AND type<>'trigger'");
  while (query.step()) {
    const std::string kind =
        kind_unless_table(std::string(query.text(0)), std::string(query.text(1)));
    if (kind.empty()) continue;
    throw SqliteError(name_ + ": " + table + " is " + kind +
                      ", which is never run; expected a table, as RTAB-Map writes it; get the "
                      "database from where it was made");
  }
}

void SqliteFile::require_unchanged() const {
  bool writing = false;
  try {
    refuse_if_not_closed(file_, name_);
  } catch (const SqliteError&) {
    writing = true;
  }
  if (!writing && file_state(file_) == state_) return;
  throw SqliteError(name_ +
                    ": changed while it was read; close RTAB-Map (or copy the database while "
                    "nothing writes to it) and try again");
}

std::vector<std::string> SqliteFile::columns(const std::string& table) const {
  refuse_unless_table(table);
  // The function pragma_table_info() would be a virtual table.
  SqliteQuery query(*this, "PRAGMA table_info(" + table + ")");
  std::vector<std::string> names;
  while (query.step()) {
    std::string& name = names.emplace_back(query.text(1));
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return names;
}

SqliteQuery::SqliteQuery(const SqliteFile& file, const std::string& sql,
                         std::uint64_t most_value_bytes)
    : file_(&file), most_value_bytes_(most_value_bytes) {
  file.guard().start_statement();
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(file.handle(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  statement_.reset(statement);
  if (code != SQLITE_OK) fail();
}

void SqliteQuery::restart() {
  sqlite3_reset(statement_.get());
  file_->guard().start_statement();
}

void SqliteQuery::restart(std::int64_t first) {
  restart();
  sqlite3_bind_int64(statement_.get(), 1, first);
}

void SqliteQuery::restart(std::int64_t first, std::int64_t second) {
  restart(first);
  sqlite3_bind_int64(statement_.get(), 2, second);
}

std::string_view SqliteQuery::text(int column) const {
  const auto* const data = sqlite3_column_text(statement_.get(), column);
  if (data == nullptr) return {};
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {reinterpret_cast<const char*>(data), static_cast<std::size_t>(size)};
}

void SqliteQuery::fail() const {
  const int code = sqlite3_errcode(file_->handle());
  const std::string reason = sqlite3_errmsg(file_->handle());
  const SqliteGuard& guard = file_->guard();
  if (code == SQLITE_TOOBIG) {
    throw SqliteCorrupt(file_->name(), "expected values of at most " +
                                           std::to_string(most_value_bytes_) +
                                           " bytes, found a longer one");
  }
  if (code == SQLITE_INTERRUPT && guard.exhausted()) {
    throw SqliteError(file_->name() + ": reading it took more than " +
                      std::to_string(guard.connection_limit()) +
                      " steps, more than a file of its size needs: its pages or indexes refer to "
                      "each other; copy the file again");
  }
  if (code == SQLITE_INTERRUPT) {
    throw SqliteCorrupt(file_->name(), "expected a statement to end within " +
                                           std::to_string(guard.statement_limit()) +
                                           " steps, as for a whole file of this size: its pages or "
                                           "indexes refer to each other; copy the file again");
  }
  if (code != SQLITE_CORRUPT && code != SQLITE_NOTADB) {
    throw SqliteError(file_->name() + ": " + reason);
  }
  file_->require_unchanged();
  const std::string problem =
      "expected whole database pages, found damaged ones (" + reason + "); copy the file again, ";
  // Debian's sqlite3 has no .recover, and its .dump needs the list of tables.
  const bool tables_readable =
      sqlite3_exec(file_->handle(), "SELECT sum(length(sql)) FROM sqlite_schema", nullptr, nullptr,
                   nullptr) == SQLITE_OK;
  if (!tables_readable) {
    throw SqliteCorrupt(file_->name(),
                        problem +
                            "or try rtabmap-recovery, which comes with RTAB-Map itself (Debian 12 "
                            "has no package of it): the list of tables is damaged too, which "
                            "sqlite3 cannot get past");
  }
  // What .dump could read of a damaged file ends with ROLLBACK.
  throw SqliteCorrupt(file_->name(), problem + "or save what is readable with: sqlite3 " +
                                         shell_quoted(file_->name()) +
                                         " .dump | sed 's/^ROLLBACK;.*/COMMIT;/' | sqlite3 NEW.db "
                                         "(RTAB-Map itself, which is no package of Debian 12, "
                                         "has rtabmap-recovery)");
}

}  // namespace zonepack::packer
