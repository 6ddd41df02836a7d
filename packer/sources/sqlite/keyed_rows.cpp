// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/sqlite/keyed_rows.hpp"

#include <algorithm>
#include <tuple>

namespace zonepack::packer {
namespace {

std::string by_key(const std::string& columns, const std::string& table, const std::string& key) {
  return "SELECT " + columns + " FROM " + table + " WHERE " + key + "=?1 ORDER BY rowid";
}

std::string by_rows(const std::string& columns, const std::string& table) {
  return "SELECT " + columns + " FROM " + table + " WHERE rowid BETWEEN ?1 AND ?2 ORDER BY rowid";
}

bool has_index(const SqliteFile& file, const std::string& by_key_query) {
  SqliteQuery plan(file, "EXPLAIN QUERY PLAN " + by_key_query);
  return plan.step() && plan.text(3).starts_with("SEARCH");
}

}  // namespace

KeyedRows::KeyedRows(const SqliteFile& file, const std::string& columns, const std::string& table,
                     const std::string& key, std::uint64_t most_value_bytes)
    : indexed_(has_index(file, by_key(columns, table, key))),
      query_(file, indexed_ ? by_key(columns, table, key) : by_rows(columns, table),
             most_value_bytes) {
  if (!indexed_) note_stretches(file, table, key);
}

void KeyedRows::note_stretches(const SqliteFile& file, const std::string& table,
                               const std::string& key) {
  SqliteQuery all(file, "SELECT " + key + ", rowid FROM " + table + " ORDER BY rowid");
  while (all.step()) {
    const std::int64_t owner = all.integer(0);
    const std::int64_t row = all.integer(1);
    if (!stretches_.empty() && stretches_.back().key == owner) {
      stretches_.back().last_row = row;
    } else {
      stretches_.push_back({owner, row, row});
    }
  }
  std::sort(stretches_.begin(), stretches_.end(), [](const Stretch& a, const Stretch& b) {
    return std::tie(a.key, a.first_row) < std::tie(b.key, b.first_row);
  });
}

void KeyedRows::find(std::int64_t key) {
  if (indexed_) {
    query_.restart(key);
    return;
  }
  const auto first = std::lower_bound(stretches_.begin(), stretches_.end(), key,
                                      [](const Stretch& s, std::int64_t k) { return s.key < k; });
  key_ = key;
  stretch_ = static_cast<std::size_t>(first - stretches_.begin());
  if (first != stretches_.end()) query_.restart(first->first_row, first->last_row);
}

bool KeyedRows::next() {
  if (indexed_) return query_.step();
  while (stretch_ < stretches_.size() && stretches_[stretch_].key == key_) {
    if (query_.step()) return true;
    if (++stretch_ < stretches_.size()) {
      query_.restart(stretches_[stretch_].first_row, stretches_[stretch_].last_row);
    }
  }
  return false;
}

}  // namespace zonepack::packer
