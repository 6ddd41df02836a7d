// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "packer/record/record.hpp"

namespace zonepack::test_support {

// A SQLite file being written; throws on any error of SQLite.
class WrittenDatabase {
 public:
  explicit WrittenDatabase(const std::filesystem::path& path);
  void run(const std::string& sql);
  sqlite3* handle() { return handle_.get(); }

 private:
  std::shared_ptr<sqlite3> handle_;
};

// An INSERT whose columns are named one by one; values are bound in turn. Empty values stay
// NULL.
class Insert {
 public:
  Insert(WrittenDatabase& database, std::string table);

  Insert& integer(const char* column, std::int64_t value);
  Insert& real(const char* column, double value);  // NaN becomes NULL, as SQLite itself makes it
  Insert& text(const char* column, const std::string& value);
  Insert& blob(const char* column, const packer::Bytes& value);
  Insert& matrix(const char* column, const std::optional<packer::Matrix>& value);
  Insert& transform(const char* column, const std::optional<packer::Transform>& value);

  void run();

 private:
  using Bind = std::function<int(sqlite3_stmt*, int)>;
  Insert& add(const char* column, Bind bind);

  WrittenDatabase& database_;
  std::string table_;
  std::vector<std::pair<std::string, Bind>> values_;
};

}  // namespace zonepack::test_support
