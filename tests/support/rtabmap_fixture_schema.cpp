// SPDX-License-Identifier: Apache-2.0
#include "tests/support/rtabmap_fixture_schema.hpp"

#include <cstdio>
#include <stdexcept>
#include <tuple>

namespace zonepack::test_support {

FixtureSchema::FixtureSchema(const std::string& version) : version_text_(version) {
  if (std::sscanf(version.c_str(), "%d.%d.%d", &version_[0], &version_[1], &version_[2]) != 3) {
    throw std::runtime_error("not a version: " + version);
  }
}

bool FixtureSchema::since(int major, int minor, int patch) const {
  return std::tie(version_[0], version_[1], version_[2]) >= std::tie(major, minor, patch);
}

std::string FixtureSchema::create_statements() const {
  const auto from = [this](int minor, int patch, const char* column) {
    return since(0, minor, patch) ? std::string(column) : std::string();
  };
  const auto until = [this](int minor, int patch, const char* column) {
    return since(0, minor, patch) ? std::string() : std::string(column);
  };
  std::string sql =
      "CREATE TABLE Node (id INTEGER NOT NULL, map_id INTEGER NOT NULL, weight INTEGER, "
      "stamp FLOAT, pose BLOB, " +
      from(11, 1, "ground_truth_pose BLOB, ") + from(13, 0, "velocity BLOB, ") + "label TEXT, " +
      from(14, 0, "gps BLOB, ") + from(18, 0, "env_sensors BLOB, ") +
      "time_enter DATE, PRIMARY KEY (id));"
      "CREATE TABLE Data (id INTEGER NOT NULL, image BLOB, depth BLOB, " +
      from(22, 0, "depth_confidence BLOB, ") + "calibration BLOB, " +
      until(11, 10, "scan_max_pts INTEGER, scan_max_range FLOAT, ") + "scan BLOB, " +
      from(11, 10, "scan_info BLOB, ground_cells BLOB, obstacle_cells BLOB, ") +
      from(16, 0, "empty_cells BLOB, ") +
      from(11, 10,
           "cell_size FLOAT, view_point_x FLOAT, view_point_y FLOAT, view_point_z FLOAT, ") +
      "user_data BLOB, time_enter DATE, PRIMARY KEY (id));"
      "CREATE TABLE Link (from_id INTEGER NOT NULL, to_id INTEGER NOT NULL, type INTEGER NOT "
      "NULL, " +
      from(13, 0, "information_matrix BLOB NOT NULL, ") +
      until(13, 0, "rot_variance FLOAT NOT NULL, trans_variance FLOAT NOT NULL, ") +
      "transform BLOB, user_data BLOB, FOREIGN KEY (from_id) REFERENCES Node(id), "
      "FOREIGN KEY (to_id) REFERENCES Node(id));"
      "CREATE TABLE Word (id INTEGER NOT NULL, descriptor_size INTEGER NOT NULL, "
      "descriptor BLOB NOT NULL, time_enter DATE, PRIMARY KEY (id));"
      "CREATE TABLE " +
      feature_table() +
      " (node_id INTEGER NOT NULL, word_id INTEGER NOT NULL, pos_x FLOAT NOT NULL, "
      "pos_y FLOAT NOT NULL, size INTEGER NOT NULL, dir FLOAT NOT NULL, response FLOAT NOT NULL, " +
      from(12, 0, "octave INTEGER NOT NULL, ") + "depth_x FLOAT, depth_y FLOAT, depth_z FLOAT, " +
      from(11, 2, "descriptor_size INTEGER, descriptor BLOB, ") +
      "FOREIGN KEY (node_id) REFERENCES Node(id));"
      "CREATE TABLE Info (STM_size INTEGER, last_sign_added INTEGER, process_mem_used INTEGER, "
      "database_mem_used INTEGER, dictionary_size INTEGER, parameters TEXT, time_enter DATE);"
      "CREATE TABLE Statistics (id INTEGER NOT NULL, stamp FLOAT, data BLOB, " +
      from(16, 2, "wm_state BLOB, ") +
      "FOREIGN KEY (id) REFERENCES Node(id));"
      "CREATE TABLE Admin (version TEXT, " +
      from(12, 0, "preview_image BLOB, ") +
      from(13, 0, "opt_cloud BLOB, opt_ids BLOB, opt_poses BLOB, ") +
      from(17, 0, "opt_last_localization BLOB, ") +
      from(13, 0,
           "opt_polygons_size INTEGER, opt_polygons BLOB, opt_tex_coords BLOB, "
           "opt_tex_materials BLOB, ") +
      from(16, 0, "opt_map BLOB, opt_map_x_min FLOAT, opt_map_y_min FLOAT, ") +
      from(17, 0, "opt_map_resolution FLOAT, ") + from(23, 0, "dictionary_index BLOB, ") +
      "time_enter DATE);";
  if (since(0, 20, 0)) {
    sql +=
        "CREATE TABLE GlobalDescriptor (node_id INTEGER NOT NULL, type INTEGER NOT NULL, "
        "info BLOB, data BLOB NOT NULL, FOREIGN KEY (node_id) REFERENCES Node(id));"
        "CREATE INDEX IDX_GlobalDescriptor_node_id ON GlobalDescriptor (node_id);";
  }
  sql +=
      "CREATE UNIQUE INDEX IDX_Node_id ON Node (id);"
      "CREATE INDEX IDX_" +
      feature_table() + "_node_id ON " + feature_table() +
      " (node_id);"
      "CREATE INDEX IDX_Link_from_id ON Link (from_id);"
      "CREATE UNIQUE INDEX IDX_node_label ON Node (label);"
      "INSERT INTO Admin(version) VALUES('" +
      version_text_ + "');";
  return sql;
}

}  // namespace zonepack::test_support
