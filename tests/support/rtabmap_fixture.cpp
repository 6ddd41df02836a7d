// SPDX-License-Identifier: Apache-2.0
#include "tests/support/rtabmap_fixture.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "tests/support/blob_writer.hpp"
#include "tests/support/rtabmap_fixture_schema.hpp"
#include "tests/support/sqlite_insert.hpp"

namespace zonepack::test_support {
namespace {

using packer::Bytes;
using packer::Matrix;
using packer::SignatureRecord;
using packer::Transform;

Bytes scan_info(const packer::Scan& scan, const FixtureSchema& schema) {
  std::vector<float> values;
  if (schema.since(0, 18, 0)) {
    values = {static_cast<float>(scan.format),
              scan.range_min,
              scan.range_max,
              scan.angle_min,
              scan.angle_max,
              scan.angle_increment,
              scan.max_points};
  } else {
    values = {scan.max_points, scan.range_max};
    if (schema.since(0, 16, 1)) values.push_back(static_cast<float>(scan.format));
  }
  values.insert(values.end(), scan.local_transform.begin(), scan.local_transform.end());
  const bool says_nothing =
      std::all_of(values.begin(), values.end(), [](float value) { return value == 0; });
  return says_nothing ? Bytes() : bytes_of(values);
}

void write_node(WrittenDatabase& database, const SignatureRecord& r) {
  Insert(database, "Node")
      .integer("id", r.id)
      .integer("map_id", r.map_id)
      .integer("weight", r.weight)
      .real("stamp", r.stamp)
      .text("label", r.label)
      .transform("pose", r.odometry_pose)
      .transform("ground_truth_pose", r.ground_truth_pose)
      .blob("velocity", r.velocity)
      .blob("gps", r.gps)
      .blob("env_sensors", r.env_sensors)
      .run();
}

void write_data(WrittenDatabase& database, const FixtureSchema& schema, const SignatureRecord& r) {
  Insert row(database, "Data");
  row.integer("id", r.id)
      .blob("image", r.image)
      .blob("depth", r.depth)
      .blob("depth_confidence", r.depth_confidence)
      .blob("calibration", r.calibration)
      .matrix("user_data", r.user_data);
  if (r.scan) {
    row.blob("scan", zip(r.scan->data));
    if (schema.since(0, 11, 10)) {
      row.blob("scan_info", scan_info(*r.scan, schema));
    } else {
      row.real("scan_max_pts", r.scan->max_points).real("scan_max_range", r.scan->range_max);
    }
  }
  if (r.grid) {
    row.matrix("ground_cells", r.grid->ground)
        .matrix("obstacle_cells", r.grid->obstacle)
        .matrix("empty_cells", r.grid->empty)
        .real("cell_size", r.grid->cell_size)
        .real("view_point_x", r.grid->view_point[0])
        .real("view_point_y", r.grid->view_point[1])
        .real("view_point_z", r.grid->view_point[2]);
  }
  row.run();
}

void write_features(WrittenDatabase& database, const FixtureSchema& schema,
                    const SignatureRecord& r) {
  const packer::Features& f = r.features;
  const std::size_t stride = f.count == 0 ? 0 : f.descriptors.size() / f.count;
  Insert row(database, schema.feature_table());
  for (std::size_t i = 0; i < f.count; ++i) {
    row.integer("node_id", r.id)
        .integer("word_id", f.word_id[i])
        .real("pos_x", f.x[i])
        .real("pos_y", f.y[i])
        .real("size", f.size[i])
        .real("dir", f.angle[i])
        .real("response", f.response[i])
        .real("depth_x", f.point_x[i])
        .real("depth_y", f.point_y[i])
        .real("depth_z", f.point_z[i]);
    if (schema.since(0, 12, 0)) row.integer("octave", f.octave[i]);
    if (stride > 0) {
      const auto at = f.descriptors.begin() + static_cast<std::ptrdiff_t>(i * stride);
      row.integer("descriptor_size", f.descriptor_dim)
          .blob("descriptor", Bytes(at, at + static_cast<std::ptrdiff_t>(stride)));
    }
    row.run();
  }
}

void write_links(WrittenDatabase& database, const FixtureSchema& schema, const SignatureRecord& r) {
  Insert row(database, "Link");
  // Last link first: a reader must not rely on the order of rows.
  for (auto at = r.links.rbegin(); at != r.links.rend(); ++at) {
    const packer::Link& link = *at;
    row.integer("from_id", r.id)
        .integer("to_id", link.to)
        .integer("type", link.type)
        .transform("transform", link.transform)
        .matrix("user_data", link.user_data);
    if (schema.since(0, 13, 0)) {
      row.blob("information_matrix", bytes_of(link.information));
    } else {
      row.real("trans_variance", 1.0 / link.information.at(0))
          .real("rot_variance", 1.0 / link.information.at(35));
    }
    row.run();
  }
}

void write_optimised_poses(WrittenDatabase& database, const RtabmapFixture& fixture) {
  std::map<std::int32_t, Transform> poses = fixture.extra_poses;
  for (const SignatureRecord& r : fixture.signatures) {
    if (r.pose) poses.emplace(r.id, *r.pose);
  }
  std::vector<std::int32_t> ids;
  std::vector<float> numbers;
  for (const auto& [id, pose] : poses) {
    ids.push_back(id);
    numbers.insert(numbers.end(), pose.begin(), pose.end());
  }
  if (ids.empty()) return;
  const auto count = static_cast<std::int32_t>(ids.size());
  Insert(database, "ids").blob("b", zip({1, count, 4, bytes_of(ids)})).run();
  Insert(database, "poses").blob("b", zip({1, count * 12, 5, bytes_of(numbers)})).run();
  database.run("UPDATE Admin SET opt_ids=(SELECT b FROM ids), opt_poses=(SELECT b FROM poses)");
}

void write_optimised_map(WrittenDatabase& database, const FixtureSchema& schema,
                         const packer::OptimisedMap& map) {
  Insert(database, "map")
      .blob("b", zip(map.cells))
      .real("x", map.x_min)
      .real("y", map.y_min)
      .real("r", map.resolution)
      .run();
  database.run(
      "UPDATE Admin SET opt_map=(SELECT b FROM map), opt_map_x_min=(SELECT x FROM map), "
      "opt_map_y_min=(SELECT y FROM map)");
  if (schema.since(0, 17, 0)) {
    database.run("UPDATE Admin SET opt_map_resolution=(SELECT r FROM map)");
  }
}

}  // namespace

void write_rtabmap_database(const std::filesystem::path& path, const RtabmapFixture& fixture) {
  const FixtureSchema schema(fixture.version);
  std::filesystem::remove(path);
  WrittenDatabase database(path);
  database.run("PRAGMA synchronous=OFF; PRAGMA journal_mode=MEMORY; BEGIN;" +
               schema.create_statements() +
               "CREATE TEMP TABLE ids (b BLOB); CREATE TEMP TABLE poses (b BLOB);"
               "CREATE TEMP TABLE map (b BLOB, x REAL, y REAL, r REAL)");
  Insert(database, "Info").text("parameters", fixture.parameters).integer("STM_size", 1).run();
  for (const SignatureRecord& full : fixture.signatures) {
    const SignatureRecord record = as_schema_holds(full, fixture.version);
    write_node(database, record);
    write_data(database, schema, record);
    write_features(database, schema, record);
    write_links(database, schema, record);
    Insert row(database, "GlobalDescriptor");
    for (const packer::GlobalDescriptor& descriptor : record.global_descriptors) {
      row.integer("node_id", record.id)
          .integer("type", descriptor.type)
          .matrix("info", descriptor.info)
          .matrix("data", descriptor.data);
      row.run();
    }
  }
  if (fixture.optimised_poses && schema.since(0, 13, 0)) write_optimised_poses(database, fixture);
  if (fixture.optimised_map && schema.since(0, 16, 0)) {
    write_optimised_map(database, schema, *fixture.optimised_map);
  }
  database.run("COMMIT");
}

packer::SignatureRecord as_schema_holds(packer::SignatureRecord record,
                                        const std::string& version) {
  const FixtureSchema schema(version);
  if (!schema.since(0, 11, 1)) record.ground_truth_pose.reset();
  if (!schema.since(0, 13, 0)) {
    record.velocity.clear();
    record.pose.reset();
  }
  if (!schema.since(0, 14, 0)) record.gps.clear();
  if (!schema.since(0, 18, 0)) record.env_sensors.clear();
  if (!schema.since(0, 20, 0)) record.global_descriptors.clear();
  if (!schema.since(0, 22, 0)) record.depth_confidence.clear();
  if (!schema.since(0, 11, 10)) record.grid.reset();
  if (record.grid && !schema.since(0, 16, 0)) record.grid->empty.reset();
  if (record.grid && !record.grid->ground && !record.grid->obstacle && !record.grid->empty) {
    record.grid.reset();
  }
  if (record.scan && !schema.since(0, 18, 0)) {
    packer::Scan& scan = *record.scan;
    scan.range_min = scan.angle_min = scan.angle_max = scan.angle_increment = 0;
    if (!schema.since(0, 16, 1)) scan.format = 0;
    if (!schema.since(0, 11, 10)) scan.local_transform = {};
  }
  packer::Features& features = record.features;
  if (!schema.since(0, 12, 0)) std::fill(features.octave.begin(), features.octave.end(), 0);
  if (!schema.since(0, 11, 2)) {
    features.descriptors.clear();
    features.descriptor_dim = 0;
    features.descriptor_type = packer::Features::DescriptorType::kNone;
  }
  if (!schema.since(0, 13, 0)) {
    for (packer::Link& link : record.links) {
      const double translation = link.information.at(0), rotation = link.information.at(35);
      link.information.assign(36, 0.0);
      for (std::size_t i = 0; i < 6; ++i) {
        link.information[i * 7] = i < 3 ? translation : rotation;
      }
    }
  }
  std::stable_sort(record.links.begin(), record.links.end(),
                   [](const packer::Link& a, const packer::Link& b) {
                     return std::tie(a.type, a.to) < std::tie(b.type, b.to);
                   });
  return record;
}

void execute(const std::filesystem::path& path, const std::string& sql) {
  WrittenDatabase(path).run(sql);
}

void execute(const std::filesystem::path& path, const std::string& sql, const Bytes& blob) {
  WrittenDatabase database(path);
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement, nullptr);
  sqlite3_bind_blob(statement, 1, blob.data(), static_cast<int>(blob.size()), SQLITE_STATIC);
  const int code = sqlite3_step(statement);
  sqlite3_finalize(statement);
  if (code != SQLITE_DONE) {
    throw std::runtime_error(sqlite3_errmsg(database.handle()) + (": " + sql));
  }
}

}  // namespace zonepack::test_support
