// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// The rows of a table that belong to one key, in table order, for one key after the other. Uses the
// table's index on the key. Where the database has none, one pass over the table records which
// stretches of it belong to which key, so that no key costs a full scan.
//
// Memory: without an index, 24 bytes per stretch.
class KeyedRows {
 public:
  // `columns`: a SELECT list over `table`; `key`: the integer column that names the owner.
  KeyedRows(const SqliteFile& file, const std::string& columns, const std::string& table,
            const std::string& key, std::uint64_t most_value_bytes = kLargestPlainValueBytes);

  void find(std::int64_t key);
  // The next row of the key; read its columns from row(). Throws SqliteError.
  bool next();
  const SqliteQuery& row() const noexcept { return query_; }

 private:
  struct Stretch {
    std::int64_t key, first_row, last_row;
  };
  void note_stretches(const SqliteFile& file, const std::string& table, const std::string& key);

  bool indexed_;
  SqliteQuery query_;
  std::vector<Stretch> stretches_;  // sorted by key, then row; empty when indexed
  std::size_t stretch_ = 0;
  std::int64_t key_ = 0;
};

}  // namespace zonepack::packer
