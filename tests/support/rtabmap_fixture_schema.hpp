// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace zonepack::test_support {

// Which columns RTAB-Map's own scripts create in a version, "0.18.0" (DatabaseSchema.sql and its
// backward_compatibility folder, and the version checks of DBDriverSqlite3.cpp).
class FixtureSchema {
 public:
  explicit FixtureSchema(const std::string& version);

  bool since(int major, int minor, int patch) const;
  std::string feature_table() const { return since(0, 13, 0) ? "Feature" : "Map_Node_Word"; }

  // The statements that create tables, indexes and the row of Admin.
  std::string create_statements() const;

 private:
  std::string version_text_;
  int version_[3] = {0, 0, 0};
};

}  // namespace zonepack::test_support
