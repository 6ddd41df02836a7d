// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// What `zonepack export` must print for an RTAB-Map database of schema 0.18 or later, read by
// SQLite and zlib alone: nothing of the packer is used here, so that a mistake of its reader shows.
namespace zonepack::round_trip {

class ExpectedSignatures {
 public:
  explicit ExpectedSignatures(const std::string& database);
  ~ExpectedSignatures() { sqlite3_close(database_); }
  ExpectedSignatures(const ExpectedSignatures&) = delete;
  ExpectedSignatures& operator=(const ExpectedSignatures&) = delete;

  // Of all signatures that are not deleted, ascending.
  const std::vector<std::int64_t>& ids() const { return ids_; }

  // The keys that the database decides; payloads that are not in `payload` ("features", "scan" …)
  // are null.
  nlohmann::json signature(std::int64_t id, const std::vector<std::string>& payload) const;

 private:
  using Row = sqlite3_stmt*;
  template <typename Fn>
  void for_each_row(const std::string& sql, std::int64_t id, Fn&& fn) const;
  nlohmann::json features(std::int64_t id) const;
  nlohmann::json links(std::int64_t id, bool user_data) const;
  nlohmann::json global_descriptors(std::int64_t id) const;

  sqlite3* database_ = nullptr;
  std::vector<std::int64_t> ids_;
  std::map<std::int64_t, nlohmann::json> optimised_;
};

// Where two values first differ, as a JSON pointer with both values; empty when every key of
// `expected` is in `found` with the same value. Numbers are compared by the bits of their doubles.
std::string first_difference(const nlohmann::json& expected, const nlohmann::json& found,
                             const std::string& at = "");

}  // namespace zonepack::round_trip
