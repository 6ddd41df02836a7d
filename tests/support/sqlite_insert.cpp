// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sqlite_insert.hpp"

#include <stdexcept>

#include "tests/support/blob_writer.hpp"

namespace zonepack::test_support {

using packer::Bytes;
using packer::Matrix;
using packer::Transform;

WrittenDatabase::WrittenDatabase(const std::filesystem::path& path) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open(path.c_str(), &handle);
  handle_.reset(handle, sqlite3_close_v2);
  if (code != SQLITE_OK) throw std::runtime_error("cannot write " + path.string());
}

void WrittenDatabase::run(const std::string& sql) {
  if (sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw std::runtime_error(sqlite3_errmsg(handle_.get()) + (": " + sql));
  }
}

Insert::Insert(WrittenDatabase& database, std::string table)
    : database_(database), table_(std::move(table)) {}

Insert& Insert::integer(const char* column, std::int64_t value) {
  return add(column, [=](sqlite3_stmt* s, int i) { return sqlite3_bind_int64(s, i, value); });
}

Insert& Insert::real(const char* column, double value) {
  return add(column, [=](sqlite3_stmt* s, int i) { return sqlite3_bind_double(s, i, value); });
}

Insert& Insert::text(const char* column, const std::string& value) {
  if (value.empty()) return *this;
  return add(column, [=](sqlite3_stmt* s, int i) {
    return sqlite3_bind_text(s, i, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  });
}

Insert& Insert::blob(const char* column, const Bytes& value) {
  if (value.empty()) return *this;
  return add(column, [=](sqlite3_stmt* s, int i) {
    return sqlite3_bind_blob(s, i, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
  });
}

Insert& Insert::matrix(const char* column, const std::optional<Matrix>& value) {
  return value ? blob(column, zip(*value)) : *this;
}

Insert& Insert::transform(const char* column, const std::optional<Transform>& value) {
  return value ? blob(column, bytes_of(std::span<const float>(*value))) : *this;
}

void Insert::run() {
  std::string names, marks;
  for (const auto& [column, bind] : values_) {
    names += (names.empty() ? "" : ",") + column;
    marks += marks.empty() ? "?" : ",?";
  }
  const std::string sql = "INSERT INTO " + table_ + "(" + names + ") VALUES(" + marks + ")";
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.handle(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    throw std::runtime_error(sqlite3_errmsg(database_.handle()) + (": " + sql));
  }
  int index = 0;
  for (const auto& [column, bind] : values_) bind(statement, ++index);
  const int code = sqlite3_step(statement);
  sqlite3_finalize(statement);
  if (code != SQLITE_DONE) {
    throw std::runtime_error(sqlite3_errmsg(database_.handle()) + (": " + sql));
  }
  values_.clear();
}

Insert& Insert::add(const char* column, Bind bind) {
  values_.emplace_back(column, std::move(bind));
  return *this;
}

}  // namespace zonepack::test_support
