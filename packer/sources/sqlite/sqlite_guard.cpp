// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/sqlite/sqlite_guard.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

namespace zonepack::packer {
namespace {

constexpr int kStepsPerCall = 1000;
// The smallest row that SQLite stores takes about six bytes and thirty steps. A connection reads
// the file a few times over, and looks rows up by key.
constexpr std::uint64_t kFreeSteps = 1'000'000, kStepsPerByte = 16;
constexpr std::uint64_t kFreeStepsInAll = 10'000'000, kStepsPerByteInAll = 256;

constexpr std::pair<int, int> kLimits[] = {
    {SQLITE_LIMIT_SQL_LENGTH, 1 << 20}, {SQLITE_LIMIT_EXPR_DEPTH, 100},
    {SQLITE_LIMIT_COMPOUND_SELECT, 2},  {SQLITE_LIMIT_ATTACHED, 0},
    {SQLITE_LIMIT_TRIGGER_DEPTH, 1},    {SQLITE_LIMIT_WORKER_THREADS, 0}};

constexpr std::string_view kFunctions[] = {"lower", "length", "ifnull", "coalesce", "sum"};

// What the statements of this program need; `from` is the view or trigger that asks, if any.
int authorise(void*, int action, const char* first, const char* second, const char*,
              const char* from) {
  if (from != nullptr) return SQLITE_DENY;
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_READ:
      return SQLITE_OK;
    case SQLITE_PRAGMA:
      return first != nullptr && std::string_view(first) == "table_info" ? SQLITE_OK : SQLITE_DENY;
    case SQLITE_FUNCTION: {
      const auto known = std::find(std::begin(kFunctions), std::end(kFunctions),
                                   std::string_view(second != nullptr ? second : ""));
      return known != std::end(kFunctions) ? SQLITE_OK : SQLITE_DENY;
    }
    default:
      return SQLITE_DENY;
  }
}

// Whether the text begins with the word, after blanks, in any case; removes it.
bool take_word(std::string_view& text, std::string_view word) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) {
    text.remove_prefix(1);
  }
  const bool same = text.size() >= word.size() &&
                    std::equal(word.begin(), word.end(), text.begin(), [](char a, char b) {
                      return std::toupper(static_cast<unsigned char>(b)) == a;
                    });
  if (same) text.remove_prefix(word.size());
  return same;
}

}  // namespace

SqliteGuard::SqliteGuard(std::uint64_t file_bytes) noexcept
    : statement_limit_(kFreeSteps + kStepsPerByte * file_bytes),
      connection_limit_(kFreeStepsInAll + kStepsPerByteInAll * file_bytes) {}

void SqliteGuard::protect(sqlite3* handle) {
  handle_ = handle;
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, nullptr);
  for (const auto& [limit, most] : kLimits) sqlite3_limit(handle, limit, most);
  allow_values_of(kLargestValueBytes);
  sqlite3_set_authorizer(handle, authorise, nullptr);
  sqlite3_progress_handler(handle, kStepsPerCall, count_steps, this);
}

int SqliteGuard::count_steps(void* guard) noexcept {
  auto& self = *static_cast<SqliteGuard*>(guard);
  self.statement_steps_ += kStepsPerCall;
  self.connection_steps_ += kStepsPerCall;
  return self.statement_steps_ > self.statement_limit_ || self.exhausted() ? 1 : 0;
}

std::string kind_unless_table(const std::string& type, const std::string& sql) {
  if (type != "table") return "a " + type;
  std::string_view text = sql;
  if (take_word(text, "CREATE") && take_word(text, "TABLE")) return {};
  return "a virtual table";
}

}  // namespace zonepack::packer
