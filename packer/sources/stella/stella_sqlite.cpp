// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/stella/stella_sqlite.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "packer/sources/sqlite/cells.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kKeypointBytes =
    28;  // x, y, size, angle, response float32; octave, class int32
constexpr std::size_t kDescriptorBytes = 32;
constexpr std::size_t kMostKeypoints = 1'000'000;

template <typename T>
T value_at(std::span<const std::byte> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::span<const std::byte> blob_of(const SqliteQuery& row, int column, const CellPlace& place) {
  if (!row.is_null(column) && row.type(column) != SQLITE_BLOB) place.damaged("expected a blob");
  return row.blob(column);
}

std::span<const std::byte> blob_of(const SqliteQuery& row, int column, std::size_t count,
                                   std::size_t element, const char* element_name,
                                   const CellPlace& place) {
  const auto bytes = blob_of(row, column, place);
  if (bytes.size() != count * element) {
    place.damaged("expected " + std::to_string(count) + " " + element_name + " (" +
                  std::to_string(count * element) + " bytes), found " +
                  std::to_string(bytes.size()) + " bytes");
  }
  return bytes;
}

void require_tables(const SqliteFile& file) {
  for (const char* table : {"cameras", "keyframes", "landmarks", "associations"}) {
    if (!file.columns(table).empty()) continue;
    throw SqliteError(file.name() + ": is a map of stella_vslam without its table " + table +
                      ", as a program that ended while it saved leaves it; save the map again");
  }
}

// The ids that records are named by: rows may hold any integer.
std::int32_t id_cell(const SqliteFile& file, const SqliteQuery& row, const char* column) {
  const std::int64_t id = row.integer(0);
  if (row.type(0) == SQLITE_INTEGER && id >= 0 && id <= std::numeric_limits<std::int32_t>::max()) {
    return static_cast<std::int32_t>(id);
  }
  throw SqliteError(file.name() + ": " + column + ": holds '" +
                    std::string(row.text(0).substr(0, 40)) +
                    "', expected whole numbers from 0 to 2147483647");
}

void read_cameras(const SqliteFile& file, StellaMap& map) {
  SqliteQuery row(
      file,
      "SELECT name, setup_type, model_type, cols, rows, fx, fy, cx, cy, k1, k2, p1, p2, "
      "k3, k4, focal_x_baseline FROM cameras LIMIT 1000");
  while (row.step()) {
    const CellPlace place{&file.name(), 0, "cameras"};
    StellaCamera camera;
    camera.setup = row.text(1);
    camera.model = row.text(2);
    camera.cols = int32_cell(row, 3, place.at("cameras.cols"), 0);
    camera.rows = int32_cell(row, 4, place.at("cameras.rows"), 0);
    camera.fx = finite_cell(row, 5, place.at("cameras.fx"));
    camera.fy = finite_cell(row, 6, place.at("cameras.fy"));
    camera.cx = finite_cell(row, 7, place.at("cameras.cx"));
    camera.cy = finite_cell(row, 8, place.at("cameras.cy"));
    for (int i = 0; i < 6; ++i) {
      camera.k1_k2_p1_p2_k3_k4[static_cast<std::size_t>(i)] =
          finite_cell(row, 9 + i, place.at("cameras.k1 to k4"));
    }
    camera.focal_x_baseline = finite_cell(row, 15, place.at("cameras.focal_x_baseline"));
    map.cameras.emplace(row.text(0), camera);
  }
}

void read_keyframe(const SqliteQuery& row, const CellPlace& place, StellaKeyframe& keyframe) {
  keyframe.stamp_s = finite_cell(row, 1, place.at("keyframes.ts"));
  keyframe.camera = row.text(2);
  keyframe.orb = row.text(3);
  const auto pose = blob_of(row, 4, 16, sizeof(double), "float64", place.at("keyframes.pose_cw"));
  for (std::size_t i = 0; i < 16; ++i) {  // column by column
    keyframe.T_camera_world.matrix()(static_cast<Eigen::Index>(i % 4),
                                     static_cast<Eigen::Index>(i / 4)) =
        value_at<double>(pose, i * sizeof(double));
  }
  require_camera_pose(keyframe.T_camera_world, place.at("keyframes.pose_cw"));
  const std::int32_t keypoints = int32_cell(row, 5, place.at("keyframes.n_keypts"));
  if (keypoints < 0 || static_cast<std::size_t>(keypoints) > kMostKeypoints) {
    place.at("keyframes.n_keypts")
        .damaged("expected 0 to 1000000, found " + std::to_string(keypoints));
  }
  keyframe.keypoints = static_cast<std::size_t>(keypoints);
}

void read_keyframes(const SqliteFile& file, StellaMap& map) {
  SqliteQuery row(file,
                  "SELECT id, ts, cam, orb_params, pose_cw, n_keypts FROM keyframes ORDER BY id");
  while (row.step()) {
    StellaKeyframe keyframe;
    keyframe.id = id_cell(file, row, "keyframes.id");
    try {
      read_keyframe(row, {&file.name(), keyframe.id, "keyframes"}, keyframe);
    } catch (const DamagedSignature& error) {
      keyframe.damage = error.damage();
    } catch (const std::runtime_error& error) {  // keyframe 0, which CellPlace takes for none
      if (keyframe.id != 0) throw;
      keyframe.damage = Damage{0, "keyframes", error.what()};
    }
    map.features += keyframe.keypoints;
    map.keyframes.push_back(std::move(keyframe));
  }
}

std::vector<std::int32_t> ids_in(std::span<const std::byte> bytes) {
  std::vector<std::int32_t> ids(bytes.size() / sizeof(std::int32_t));
  if (!ids.empty()) std::memcpy(ids.data(), bytes.data(), ids.size() * sizeof(std::int32_t));
  return ids;
}

void read_edges(const SqliteFile& file, StellaMap& map) {
  SqliteQuery row(file,
                  "SELECT id, span_parent, n_loop_edges, loop_edges FROM associations ORDER BY id",
                  kLargestValueBytes);
  std::size_t next = 0;
  while (row.step()) {
    const std::int32_t id = id_cell(file, row, "associations.id");
    while (next < map.keyframes.size() && map.keyframes[next].id < id) ++next;
    if (next == map.keyframes.size() || map.keyframes[next].id != id) continue;
    StellaKeyframe& keyframe = map.keyframes[next];
    const CellPlace place{&file.name(), id, "associations"};
    try {
      keyframe.span_parent = int32_cell(row, 1, place.at("associations.span_parent"), -1);
      const std::int32_t edges = int32_cell(row, 2, place.at("associations.n_loop_edges"), 0);
      keyframe.loop_edges =
          ids_in(blob_of(row, 3, static_cast<std::size_t>(std::max(edges, 0)), sizeof(std::int32_t),
                         "int32", place.at("associations.loop_edges")));
    } catch (const std::runtime_error& error) {
      if (!keyframe.damage) keyframe.damage = Damage{id, "associations", error.what()};
    }
  }
}

void read_landmarks(const SqliteFile& file, StellaMap& map) {
  SqliteQuery row(file, "SELECT id, pos_w FROM landmarks ORDER BY id");
  std::size_t without = 0;
  while (row.step()) {
    const std::int32_t id = id_cell(file, row, "landmarks.id");
    const auto place = row.blob(1);
    std::array<double, 3> p{};
    bool usable = place.size() == sizeof p;
    if (usable) std::memcpy(p.data(), place.data(), sizeof p);
    usable = usable && std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    if (!usable) {
      ++without;
      continue;
    }
    map.landmark_ids.push_back(id);
    map.landmarks.push_back(p);
  }
  if (without > 0) {
    map.warnings.push_back(file.name() + ": landmarks.pos_w: " + std::to_string(without) +
                           " of the landmarks have no place (expected 3 float64); their keypoints "
                           "have no point");
  }
}

class SqliteFeatures : public StellaFeatureReader {
 public:
  SqliteFeatures(const std::filesystem::path& path)
      : path_(path),
        file_(path),
        keyframes_(file_,
                   "SELECT undist_keypts, descs, x_rights, depths FROM keyframes WHERE id=?1",
                   kLargestValueBytes),
        associations_(file_, "SELECT lm_ids FROM associations WHERE id=?1", kLargestValueBytes) {}

  std::unique_ptr<StellaFeatureReader> reopen() const override {
    auto again = std::make_unique<SqliteFeatures>(path_);
    require_unchanged();
    return again;
  }

  void require_unchanged() const override { file_.require_unchanged(); }

  void read(const StellaKeyframe& keyframe, StellaFeatures& out) override {
    const CellPlace place{&path_text_, keyframe.id, ""};
    const std::size_t n = keyframe.keypoints;
    try {
      keyframes_.restart(keyframe.id);
      if (!keyframes_.step()) place.at("keyframes.id").damaged("expected a row, found none");
      read_keypoints(blob_of(keyframes_, 0, n, kKeypointBytes, "keypoints",
                             place.at("keyframes.undist_keypts")),
                     out);
      assign(out.descriptors, blob_of(keyframes_, 1, n, kDescriptorBytes, "descriptors",
                                      place.at("keyframes.descs")));
      for (const int column : {2, 3}) {  // a monocular camera has none
        const char* const name = column == 2 ? "keyframes.x_rights" : "keyframes.depths";
        if (blob_of(keyframes_, column, place.at(name)).empty()) continue;
        blob_of(keyframes_, column, n, sizeof(float), "float32", place.at(name));
      }
      associations_.restart(keyframe.id);
      if (!associations_.step()) place.at("associations.id").damaged("expected a row, found none");
      out.landmark = ids_in(blob_of(associations_, 0, n, sizeof(std::int32_t), "int32",
                                    place.at("associations.lm_ids")));
    } catch (const SqliteCorrupt& error) {
      throw DamagedSignature(path_text_, {keyframe.id, "database file", error.problem()});
    }
  }

 private:
  static void read_keypoints(std::span<const std::byte> bytes, StellaFeatures& out) {
    const std::size_t n = bytes.size() / kKeypointBytes;
    for (auto* column : {&out.x, &out.y, &out.size, &out.angle, &out.response}) column->resize(n);
    out.octave.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = bytes.subspan(i * kKeypointBytes);
      out.x[i] = value_at<float>(row, 0);
      out.y[i] = value_at<float>(row, 4);
      out.size[i] = value_at<float>(row, 8);
      out.angle[i] = value_at<float>(row, 12);
      out.response[i] = value_at<float>(row, 16);
      out.octave[i] = value_at<std::int32_t>(row, 20);
    }
  }

  std::filesystem::path path_;
  std::string path_text_ = path_.string();
  SqliteFile file_;
  SqliteQuery keyframes_, associations_;
};

}  // namespace

StellaFile open_stella_sqlite(const std::filesystem::path& path) {
  StellaFile out;
  out.map.version = "sqlite";
  const SqliteFile file(path);
  require_tables(file);
  read_cameras(file, out.map);
  read_keyframes(file, out.map);
  read_edges(file, out.map);
  read_landmarks(file, out.map);
  sort_by_id(out.map, path.string());
  out.map.feature_bytes =
      out.map.features * (kKeypointBytes + kDescriptorBytes + sizeof(std::int32_t)) +
      out.map.landmarks.size() * 24;
  out.features = std::make_unique<SqliteFeatures>(path);
  file.require_unchanged();
  return out;
}

}  // namespace zonepack::packer
