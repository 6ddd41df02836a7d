// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_outline.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "packer/sources/rtabmap/detector_text.hpp"
#include "packer/sources/rtabmap/zlib_blob.hpp"
#include "packer/sources/sqlite/cells.hpp"
#include "packer/sources/sqlite/keyed_rows.hpp"

namespace zonepack::packer {
namespace {

constexpr std::int32_t kDeletedWeight = -9;
constexpr std::uint64_t kFeatureRowBytes = 72;
constexpr std::int32_t kInt32 = 4, kFloat32 = 5, kInt8 = 1;

void add_damage(MapOutline& outline, NodeOutline& node, const Damage& damage) {
  if (!node.damaged) outline.damages.push_back(damage);
  node.damaged = true;
}

// SQLite follows a page as often as others refer to it, and then rows come again.
[[noreturn]] void refuse_order(const SqliteFile& file, std::int32_t id, std::int32_t before) {
  throw SqliteError(file.name() + ": the rows of Node are out of order, " + std::to_string(id) +
                    " after " + std::to_string(before) +
                    ": its pages refer to each other; copy the file again");
}

// Reads the row of one node into the outline. Rows come in order of id.
void take_node(const SqliteFile& file, const SqliteQuery& row, std::int32_t id,
               MapOutline& outline) {
  if (!outline.nodes.empty() && outline.nodes.back().id > id) {
    refuse_order(file, id, outline.nodes.back().id);
  }
  NodeOutline node;
  node.id = id;
  std::optional<Damage> damage;
  try {
    read_node(row, CellPlace{&file.name(), id, "Node"}, node);
  } catch (const DamagedSignature& error) {
    damage = error.damage();
  }
  if (node.weight == kDeletedWeight) {
    ++outline.deleted_nodes;
    return;
  }
  if (!outline.nodes.empty() && outline.nodes.back().id == id) {
    damage = Damage{id, "Node.id", "expected one row, found two"};
  } else {
    outline.nodes.push_back(std::move(node));
  }
  if (damage) add_damage(outline, outline.nodes.back(), *damage);
}

// The id of the row; nullopt, and a damage without a signature, where a pack has no place for it.
std::optional<std::int32_t> node_id(const SqliteQuery& row, MapOutline& outline) {
  const std::int64_t id = row.integer(0);
  if (row.type(0) == SQLITE_INTEGER && id >= 1 && id <= std::numeric_limits<std::int32_t>::max()) {
    return static_cast<std::int32_t>(id);
  }
  outline.damages.push_back({0, "Node.id",
                             "holds '" + std::string(row.text(0).substr(0, 40)) +
                                 "', expected whole numbers from 1 to 2147483647"});
  return std::nullopt;
}

// Where a row of Node cannot be read: the ids alone first, which take no values off other pages,
// then each row for itself, so that only those that cannot be read are damaged.
void read_nodes_one_by_one(const SqliteFile& file, const RtabmapSchema& schema,
                           MapOutline& outline) {
  outline.nodes.clear();
  outline.damages.clear();
  outline.deleted_nodes = 0;
  std::vector<std::int32_t> ids;
  SqliteQuery all(file, "SELECT id FROM Node ORDER BY id");
  while (all.step()) {
    const auto id = node_id(all, outline);
    if (!id || (!ids.empty() && ids.back() == *id)) continue;
    if (!ids.empty() && ids.back() > *id) refuse_order(file, *id, ids.back());
    ids.push_back(*id);
  }
  KeyedRows rows(file, node_columns(schema), "Node", "id");
  for (const std::int32_t id : ids) {
    try {
      rows.find(id);
      while (rows.next()) take_node(file, rows.row(), id, outline);
    } catch (const SqliteCorrupt& error) {
      if (outline.nodes.empty() || outline.nodes.back().id != id) {
        outline.nodes.push_back({});
        outline.nodes.back().id = id;
      }
      add_damage(outline, outline.nodes.back(), {id, "Node", error.problem()});
    }
  }
}

void read_nodes(const SqliteFile& file, const RtabmapSchema& schema, MapOutline& outline) {
  try {
    SqliteQuery row(file, "SELECT " + node_columns(schema) + " FROM Node ORDER BY id");
    while (row.step()) {
      if (const auto id = node_id(row, outline)) take_node(file, row, *id, outline);
    }
  } catch (const SqliteCorrupt&) {
    read_nodes_one_by_one(file, schema, outline);
  }
}

struct AdminMatrix {
  bool present = false;
  Matrix matrix;
};

AdminMatrix admin_matrix(const SqliteFile& file, const SqliteQuery& row, int column,
                         const char* name, std::int32_t type) {
  AdminMatrix result;
  const CellPlace place{&file.name(), 0, name};
  const auto blob = blob_cell(row, column, place);
  if (blob.empty()) return result;
  MatrixUnpacker().unpack(blob, place, result.matrix);
  if (result.matrix.type != type) {
    place.damaged("expected " + describe_type(type) + ", found " +
                  describe_type(result.matrix.type));
  }
  result.present = true;
  return result;
}

// Throws unless the transform is a rotation and a place on a map.
void require_pose(const Transform& T, const CellPlace& place) {
  constexpr float kFurthest_m = 1e7F;
  constexpr float kTolerance = 0.01F;  // of a unit matrix; RTAB-Map stores float32
  for (const int at : {3, 7, 11}) {
    if (std::fabs(T[static_cast<std::size_t>(at)]) >= kFurthest_m) {
      place.damaged("expected a position within 10,000 km, found " +
                    std::to_string(T[static_cast<std::size_t>(at)]) + " m");
    }
  }
  const auto dot = [&T](std::size_t a, std::size_t b) {
    return T[4 * a] * T[4 * b] + T[4 * a + 1] * T[4 * b + 1] + T[4 * a + 2] * T[4 * b + 2];
  };
  const float determinant = T[0] * (T[5] * T[10] - T[6] * T[9]) -
                            T[1] * (T[4] * T[10] - T[6] * T[8]) +
                            T[2] * (T[4] * T[9] - T[5] * T[8]);
  bool rotation = determinant > 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      rotation = rotation && std::fabs(dot(a, b) - (a == b ? 1.0F : 0.0F)) <= kTolerance;
    }
  }
  if (!rotation) place.damaged("expected a rotation in the first three columns, found none");
}

void assign_pose(const SqliteFile& file, MapOutline& outline, std::int32_t id,
                 std::span<const std::byte> pose) {
  const CellPlace place{&file.name(), id, "Admin.opt_poses"};
  if (id <= 0) {
    ++outline.landmark_poses;
    return;
  }
  auto* const node = const_cast<NodeOutline*>(outline.find(id));
  if (node == nullptr) {
    ++outline.poses_without_node;
    return;
  }
  if (node->pose) {
    add_damage(outline, *node, {id, "Admin.opt_ids", "expected each id once, found it twice"});
    return;
  }
  try {
    node->pose = transform_from(pose, place);
    if (node->pose) require_pose(*node->pose, place);
  } catch (const DamagedSignature& error) {
    add_damage(outline, *node, error.damage());
  }
}

void read_optimised_poses(const SqliteFile& file, const RtabmapSchema& schema,
                          MapOutline& outline) {
  SqliteQuery row(file,
                  "SELECT " + schema.columns("Admin", {"opt_ids", "opt_poses"}) +
                      " FROM Admin WHERE version IS NOT NULL",
                  kLargestValueBytes);
  if (!row.step()) return;
  const AdminMatrix ids = admin_matrix(file, row, 0, "Admin.opt_ids", kInt32);
  const AdminMatrix poses = admin_matrix(file, row, 1, "Admin.opt_poses", kFloat32);
  const std::size_t count = ids.matrix.data.size() / sizeof(std::int32_t);
  const std::size_t pose_bytes = sizeof(Transform);
  if (poses.matrix.data.size() != count * pose_bytes) {
    throw SqliteError(file.name() + ": Admin.opt_ids holds " + std::to_string(count) +
                      " ids and Admin.opt_poses " +
                      std::to_string(poses.matrix.data.size() / sizeof(float)) +
                      " numbers, expected 12 for each id; open the database in RTAB-Map and close "
                      "it so that it saves them again");
  }
  outline.has_optimised_poses = count > 0;
  const std::span<const std::byte> id_bytes(ids.matrix.data);
  const std::span<const std::byte> pose_span(poses.matrix.data);
  for (std::size_t i = 0; i < count; ++i) {
    std::int32_t id;
    std::memcpy(&id, id_bytes.data() + i * sizeof(id), sizeof(id));
    assign_pose(file, outline, id, pose_span.subspan(i * pose_bytes, pose_bytes));
  }
}

// Of nodes that only their odometry places.
void check_odometry_poses(const SqliteFile& file, MapOutline& outline) {
  for (NodeOutline& node : outline.nodes) {
    if (node.damaged || node.pose || !node.odometry_pose) continue;
    try {
      require_pose(*node.odometry_pose, {&file.name(), node.id, "Node.pose"});
    } catch (const DamagedSignature& error) {
      add_damage(outline, node, error.damage());
    }
  }
}

void count_unlinked(MapOutline& outline) {
  for (const NodeOutline& node : outline.nodes) {
    if (!node.pose && !node.damaged) ++outline.unlinked_by_session[node.map_id];
  }
}

void read_optimised_map(const SqliteFile& file, const RtabmapSchema& schema, MapOutline& outline) {
  SqliteQuery row(file,
                  "SELECT " +
                      schema.columns("Admin", {"opt_map", "opt_map_x_min", "opt_map_y_min",
                                               "opt_map_resolution"}) +
                      " FROM Admin WHERE version IS NOT NULL",
                  kLargestValueBytes);
  if (!row.step()) return;
  AdminMatrix cells = admin_matrix(file, row, 0, "Admin.opt_map", kInt8);
  if (!cells.present) return;
  // Drawn, not packed, so the nearest float32 will do.
  const auto number = [&](int column, const char* name) {
    const CellPlace place{&file.name(), 0, name};
    const double value = finite_cell(row, column, place);
    if (std::fabs(value) > std::numeric_limits<float>::max()) place.damaged("is too large");
    return static_cast<float>(value);
  };
  outline.optimised_map =
      OptimisedMap{std::move(cells.matrix), number(1, "Admin.opt_map_x_min"),
                   number(2, "Admin.opt_map_y_min"), number(3, "Admin.opt_map_resolution")};
}

void read_parameters(const SqliteFile& file, const RtabmapSchema& schema, MapOutline& outline) {
  if (!schema.has("Info", "parameters")) return;
  SqliteQuery row(file,
                  "SELECT parameters FROM Info WHERE parameters IS NOT NULL "
                  "ORDER BY rowid DESC LIMIT 1");
  if (row.step()) outline.parameters = text_cell(row, 0, {&file.name(), 0, "Info.parameters"});
}

std::uint64_t count(const SqliteFile& file, const std::string& sql) {
  SqliteQuery row(file, sql);
  return row.step() ? static_cast<std::uint64_t>(row.integer(0)) : 0;
}

std::string blob_sum(const RtabmapSchema& schema, std::initializer_list<const char*> columns) {
  std::string sum = "SELECT sum(0";
  for (const char* column : columns) {
    if (schema.has("Data", column)) {
      sum.append("+ifnull(length(").append(column).append("),0)");
    }
  }
  return sum + ") FROM Data WHERE id IN (SELECT id FROM Node WHERE weight IS NOT -9)";
}

void read_totals(const SqliteFile& file, const RtabmapSchema& schema, MapOutline& outline) {
  const std::string& features = schema.feature_table();
  if (schema.has(features)) {
    // SQLite walks the pages for a plain count(*) without counting steps.
    std::string sql = "SELECT sum(1) FROM " + features;
    if (outline.deleted_nodes != 0) {
      sql += " WHERE node_id IN (SELECT id FROM Node WHERE weight IS NOT -9)";
    }
    outline.feature_count = count(file, sql);
    outline.feature_bytes = outline.feature_count * kFeatureRowBytes;
  }
  if (schema.has("Data")) {
    outline.scan_bytes = count(file, blob_sum(schema, {"scan"}));
    outline.grid_bytes =
        count(file, blob_sum(schema, {"ground_cells", "obstacle_cells", "empty_cells"}));
  }
  if (schema.has("Link")) {
    outline.links_to_missing_nodes = count(
        file, "SELECT sum(1) FROM Link WHERE to_id > 0 AND to_id NOT IN (SELECT id FROM Node)");
  }
}

// For parts that the map can do without: an unreadable part gives a warning, not an error.
template <typename Read>
void read_if_possible(MapOutline& outline, const char* without, Read read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    outline.warnings.push_back(std::string(error.what()) + "; going on without " + without);
  }
}

}  // namespace

std::string node_columns(const RtabmapSchema& schema) {
  return schema.columns("Node", {"id", "map_id", "weight", "stamp", "label", "pose",
                                 "ground_truth_pose", "velocity", "gps", "env_sensors"});
}

void read_node(const SqliteQuery& row, const CellPlace& place, NodeOutline& node) {
  node.weight = int32_cell(row, 2, place.at("Node.weight"), 0);
  node.map_id = int32_cell(row, 1, place.at("Node.map_id"));
  node.stamp = finite_cell(row, 3, place.at("Node.stamp"));
  node.label = text_cell(row, 4, place.at("Node.label"));
  node.odometry_pose = transform_cell(row, 5, place.at("Node.pose"));
}

MapOutline read_outline(const SqliteFile& file, const RtabmapSchema& schema) {
  MapOutline outline;
  outline.schema_version = schema.version().text();
  outline.warnings = schema.warnings();
  read_nodes(file, schema, outline);
  read_optimised_poses(file, schema, outline);
  check_odometry_poses(file, outline);
  count_unlinked(outline);
  read_if_possible(outline, "RTAB-Map's own occupancy grid",
                   [&] { read_optimised_map(file, schema, outline); });
  read_if_possible(outline, "its parameters", [&] { read_parameters(file, schema, outline); });
  outline.detector = detector_text(outline);
  read_if_possible(outline, "some totals of the size report",
                   [&] { read_totals(file, schema, outline); });
  return outline;
}

}  // namespace zonepack::packer
