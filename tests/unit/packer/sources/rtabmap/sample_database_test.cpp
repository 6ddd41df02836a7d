// SPDX-License-Identifier: Apache-2.0
// The sample map, read field by field against SQLite and zlib called directly.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "packer/sources/rtabmap/rtabmap_database.hpp"

namespace zonepack::packer {
namespace {

const std::string kSample = ZONEPACK_TEST_DATA "/hospital-small.db";
constexpr std::size_t kNodes = 185, kFeatures = 44022, kLinks = 380;

class PlainQuery {
 public:
  explicit PlainQuery(const std::string& sql) {
    const std::string uri = "file:" + kSample + "?mode=ro&immutable=1";
    sqlite3* db = nullptr;
    EXPECT_EQ(sqlite3_open_v2(uri.c_str(), &db, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr),
              SQLITE_OK);
    db_.reset(db, sqlite3_close_v2);
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr), SQLITE_OK);
    statement_.reset(statement, sqlite3_finalize);
  }
  bool step() { return sqlite3_step(statement_.get()) == SQLITE_ROW; }
  int integer(int c) { return sqlite3_column_int(statement_.get(), c); }
  double real(int c) { return sqlite3_column_double(statement_.get(), c); }
  Bytes blob(int c) {
    const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), c));
    return data == nullptr ? Bytes()
                           : Bytes(data, data + sqlite3_column_bytes(statement_.get(), c));
  }
  std::string text(int c) {
    const auto* text = sqlite3_column_text(statement_.get(), c);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
  }
  Bytes unzipped(int c, std::size_t expected_bytes) {
    const Bytes zipped = blob(c);
    Bytes out(expected_bytes + 1);
    uLongf size = out.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                         reinterpret_cast<const Bytef*>(zipped.data()), zipped.size()),
              Z_OK);
    out.resize(size);
    return out;
  }

 private:
  std::shared_ptr<sqlite3> db_;
  std::shared_ptr<sqlite3_stmt> statement_;
};

Bytes bytes_of(const Transform& transform) {
  Bytes bytes(sizeof(transform));
  std::memcpy(bytes.data(), transform.data(), bytes.size());
  return bytes;
}

Bytes optional_bytes(const std::optional<Transform>& transform) {
  return transform ? bytes_of(*transform) : Bytes();
}

TEST(SampleDatabase, GivesItsOutline) {
  const RtabmapDatabase database(kSample);
  const MapOutline& outline = database.outline();
  EXPECT_EQ(outline.schema_version, "0.23.8");
  EXPECT_EQ(outline.nodes.size(), kNodes);
  EXPECT_EQ(outline.feature_count, kFeatures);
  EXPECT_EQ(outline.scan_bytes, 461884u);  // sum(length(scan)) by the sqlite3 shell
  EXPECT_EQ(outline.grid_bytes, 5527753u);
  EXPECT_TRUE(outline.has_optimised_poses);
  EXPECT_EQ(outline.unlinked(), 0u);
  EXPECT_EQ(outline.deleted_nodes, 0u);
  EXPECT_EQ(outline.links_to_missing_nodes, 0u);
  EXPECT_TRUE(outline.damages.empty());
  EXPECT_TRUE(outline.warnings.empty());
  EXPECT_FALSE(outline.optimised_map.has_value());
  EXPECT_EQ(outline.parameter("Kp/DetectorStrategy"), "8");
  EXPECT_EQ(outline.parameter("Kp/DetectorStrateg"), std::nullopt);
}

TEST(SampleDatabase, NodesAreThoseOfTheTable) {
  RtabmapDatabase database(kSample);
  PlainQuery plain(
      "SELECT id,map_id,weight,stamp,label,pose,ground_truth_pose,velocity FROM Node ORDER BY id");
  std::size_t count = 0;
  while (plain.step()) {
    const SignatureRecord record = database.read(plain.integer(0), PayloadSet());
    EXPECT_EQ(record.id, plain.integer(0));
    EXPECT_EQ(record.map_id, plain.integer(1));
    EXPECT_EQ(record.weight, plain.integer(2));
    EXPECT_EQ(record.stamp, plain.real(3));
    EXPECT_EQ(record.label, plain.text(4));
    EXPECT_EQ(optional_bytes(record.odometry_pose), plain.blob(5));
    EXPECT_EQ(optional_bytes(record.ground_truth_pose), plain.blob(6));
    EXPECT_EQ(record.velocity, plain.blob(7));
    ++count;
  }
  EXPECT_EQ(count, kNodes);
}

TEST(SampleDatabase, OptimisedPosesAreThoseOfAdmin) {
  RtabmapDatabase database(kSample);
  PlainQuery plain("SELECT opt_ids, opt_poses FROM Admin");
  ASSERT_TRUE(plain.step());
  const Bytes ids = plain.unzipped(0, kNodes * 4);
  const Bytes poses = plain.unzipped(1, kNodes * 48);
  ASSERT_EQ(ids.size(), kNodes * 4);
  ASSERT_EQ(poses.size(), kNodes * 48);
  for (std::size_t i = 0; i < kNodes; ++i) {
    std::int32_t id;
    std::memcpy(&id, ids.data() + i * 4, 4);
    const auto pose = database.read(id, PayloadSet()).pose;
    EXPECT_EQ(optional_bytes(pose),
              Bytes(poses.begin() + static_cast<std::ptrdiff_t>(i * 48),
                    poses.begin() + static_cast<std::ptrdiff_t>(i * 48 + 48)));
  }
}

TEST(SampleDatabase, FeaturesAreThoseOfTheTableInItsOrder) {
  RtabmapDatabase database(kSample);
  PlainQuery plain(
      "SELECT node_id,word_id,pos_x,pos_y,size,dir,response,octave,depth_x,depth_y,depth_z,"
      "descriptor_size,descriptor FROM Feature ORDER BY node_id, rowid");
  SignatureRecord record;
  std::size_t i = 0, total = 0;
  while (plain.step()) {
    if (record.id != plain.integer(0)) {
      EXPECT_EQ(i, record.features.count);
      database.read(plain.integer(0), PayloadSet(), record);
      i = 0;
    }
    const Features& f = record.features;
    ASSERT_LT(i, f.count);
    EXPECT_EQ(f.word_id[i], plain.integer(1));
    EXPECT_EQ(f.x[i], plain.real(2));
    EXPECT_EQ(f.y[i], plain.real(3));
    EXPECT_EQ(f.size[i], plain.real(4));
    EXPECT_EQ(f.angle[i], plain.real(5));
    EXPECT_EQ(f.response[i], plain.real(6));
    EXPECT_EQ(f.octave[i], plain.integer(7));
    EXPECT_EQ(f.point_x[i], plain.real(8));
    EXPECT_EQ(f.point_y[i], plain.real(9));
    EXPECT_EQ(f.point_z[i], plain.real(10));
    ASSERT_EQ(f.descriptor_type, Features::DescriptorType::kU8);
    ASSERT_EQ(f.descriptor_dim, static_cast<std::uint32_t>(plain.integer(11)));
    const auto begin = f.descriptors.begin() + static_cast<std::ptrdiff_t>(i * f.descriptor_dim);
    EXPECT_EQ(Bytes(begin, begin + f.descriptor_dim), plain.blob(12));
    ++i;
    ++total;
  }
  EXPECT_EQ(i, record.features.count);
  EXPECT_EQ(total, kFeatures);
}

TEST(SampleDatabase, ScansGridsAndImagesAreThoseOfTheTable) {
  RtabmapDatabase database(kSample);
  PlainQuery plain(
      "SELECT id,calibration,image,depth,scan,scan_info,obstacle_cells,empty_cells,cell_size,"
      "view_point_x,view_point_y,view_point_z FROM Data ORDER BY id");
  std::size_t count = 0;
  while (plain.step()) {
    const SignatureRecord record = database.read(plain.integer(0), PayloadSet());
    EXPECT_EQ(record.calibration, plain.blob(1));
    EXPECT_EQ(record.image, plain.blob(2));
    EXPECT_EQ(record.depth, plain.blob(3));
    ASSERT_TRUE(record.scan.has_value());
    EXPECT_EQ(record.scan->data.data, plain.unzipped(4, record.scan->data.data.size()));
    const Bytes info = plain.blob(5);
    ASSERT_EQ(info.size(), 76u);
    std::array<float, 19> f;
    std::memcpy(f.data(), info.data(), info.size());
    EXPECT_EQ(static_cast<float>(record.scan->format), f[0]);
    EXPECT_EQ(record.scan->range_min, f[1]);
    EXPECT_EQ(record.scan->range_max, f[2]);
    EXPECT_EQ(record.scan->angle_min, f[3]);
    EXPECT_EQ(record.scan->angle_max, f[4]);
    EXPECT_EQ(record.scan->angle_increment, f[5]);
    EXPECT_EQ(record.scan->max_points, f[6]);
    EXPECT_EQ(bytes_of(record.scan->local_transform), Bytes(info.begin() + 28, info.end()));
    ASSERT_TRUE(record.grid.has_value());
    EXPECT_FALSE(record.grid->ground.has_value());
    EXPECT_EQ(record.grid->obstacle->data, plain.unzipped(6, record.grid->obstacle->data.size()));
    EXPECT_EQ(record.grid->empty->data, plain.unzipped(7, record.grid->empty->data.size()));
    EXPECT_EQ(record.grid->cell_size, plain.real(8));
    EXPECT_EQ(record.grid->view_point[0], plain.real(9));
    EXPECT_EQ(record.grid->view_point[1], plain.real(10));
    EXPECT_EQ(record.grid->view_point[2], plain.real(11));
    ++count;
  }
  EXPECT_EQ(count, kNodes);
}

TEST(SampleDatabase, LinksAreThoseOfTheTableSortedByTypeAndDestination) {
  RtabmapDatabase database(kSample);
  PlainQuery plain(
      "SELECT from_id,to_id,type,information_matrix,transform FROM Link ORDER BY "
      "from_id,type,to_id");
  SignatureRecord record;
  std::size_t i = 0, total = 0;
  while (plain.step()) {
    if (record.id != plain.integer(0)) {
      EXPECT_EQ(i, record.links.size());
      database.read(plain.integer(0), PayloadSet(), record);
      i = 0;
    }
    ASSERT_LT(i, record.links.size());
    const Link& link = record.links[i++];
    EXPECT_EQ(link.to, plain.integer(1));
    EXPECT_EQ(link.type, plain.integer(2));
    const Bytes information = plain.blob(3);
    ASSERT_EQ(link.information.size() * sizeof(double), information.size());
    EXPECT_EQ(std::memcmp(link.information.data(), information.data(), information.size()), 0);
    EXPECT_EQ(optional_bytes(link.transform), plain.blob(4));
    ++total;
  }
  EXPECT_EQ(total, kLinks);
}

TEST(SampleDatabase, PayloadsThatAreNotWantedAreAbsent) {
  RtabmapDatabase database(kSample);
  SignatureRecord record = database.read(1, PayloadSet());
  ASSERT_GT(record.features.count, 0u);
  database.read(2,
                PayloadSet{.features = false,
                           .scan = false,
                           .grid = false,
                           .image = false,
                           .depth = false,
                           .userdata = false},
                record);
  EXPECT_EQ(record.features.count, 0u);
  EXPECT_FALSE(record.scan.has_value());
  EXPECT_FALSE(record.grid.has_value());
  EXPECT_TRUE(record.image.empty());
  EXPECT_FALSE(record.calibration.empty());
  EXPECT_FALSE(record.links.empty());
}

TEST(SampleDatabase, ReopenedReaderReadsTheSame) {
  RtabmapDatabase first(kSample);
  const std::unique_ptr<MapSource> second = first.reopen();
  EXPECT_EQ(&first.outline(), &second->outline());
  EXPECT_EQ(first.read(7, PayloadSet()).features.descriptors,
            second->read(7, PayloadSet()).features.descriptors);
}

TEST(SampleDatabase, StaysAsItWas) {
  const auto before = std::filesystem::last_write_time(kSample);
  const auto folder_before = std::filesystem::last_write_time(ZONEPACK_TEST_DATA);
  {
    RtabmapDatabase database(kSample);
    database.read(1, PayloadSet());
  }
  EXPECT_EQ(std::filesystem::last_write_time(kSample), before);
  EXPECT_EQ(std::filesystem::last_write_time(ZONEPACK_TEST_DATA), folder_before);
}

}  // namespace
}  // namespace zonepack::packer
