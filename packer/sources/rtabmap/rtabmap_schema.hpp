// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// The version an RTAB-Map database carries in Admin.version, "0.23.8".
struct SchemaVersion {
  int major = 0, minor = 0, patch = 0;
  // clang-tidy takes the 0 that a defaulted <=> compares with for a pointer.
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const SchemaVersion&, const SchemaVersion&) = default;
  std::string text() const;
};

// Which tables and columns an RTAB-Map database has. These decide what is read; the version matters
// only where the same column changed its meaning (calibration and scan_info before 0.18).
class RtabmapSchema {
 public:
  // Throws SqliteError when this is not an RTAB-Map database, or it is older than 0.11, or newer
  // than 0.23 and lacks a column that this program needs.
  explicit RtabmapSchema(const SqliteFile& file);

  SchemaVersion version() const noexcept { return version_; }
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  bool has(const std::string& table) const { return tables_.contains(table); }
  bool has(const std::string& table, const std::string& column) const;
  // The table of keypoints: Feature, or Map_Node_Word before 0.13.
  const std::string& feature_table() const noexcept { return feature_table_; }

  // A SELECT list over `table` in the given order, with NULL for each missing column, so that a
  // column's position does not depend on the version.
  std::string columns(const std::string& table, std::initializer_list<const char*> names) const;

 private:
  void require_known_columns(const SqliteFile& file) const;

  SchemaVersion version_;
  std::string feature_table_;
  std::map<std::string, std::vector<std::string>> tables_;
  std::vector<std::string> warnings_;
};

}  // namespace zonepack::packer
