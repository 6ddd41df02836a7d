// SPDX-License-Identifier: Apache-2.0
// Fuses the depth images of an RTAB-Map database into what other mappers would have made of them:
// an nvblox map (TSDF and colour) and a point cloud. Plain code that shares nothing with the
// packer, to measure packs of such maps on real surfaces.
//
//   fuse_depth DATABASE OUT.nvblx OUT.pcd
//
// TSDF as nvblox integrates it: voxels of 5 cm in blocks of 8, distances along the optical axis cut
// off at 4 voxels, each observation weighted by 1 / depth^2, weights at most 5.
#include <png.h>
#include <sqlite3.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <vector>

// Needs stdio first.
#include <jpeglib.h>

namespace {

constexpr float kVoxel_m = 0.05F;
constexpr int kSide = 8;
constexpr float kBlock_m = kVoxel_m * kSide;
constexpr float kTruncation_m = 4 * kVoxel_m;
constexpr float kMostWeight = 5;
constexpr float kMostDepth_m = 7;  // nvblox's default reach
constexpr std::size_t kVoxels = std::size_t{kSide} * kSide * kSide;

// Row-major 3x4.
using Pose = std::array<float, 12>;
struct Point {
  float x, y, z;
};

Point moved(const Pose& T, Point p) {
  return {T[0] * p.x + T[1] * p.y + T[2] * p.z + T[3], T[4] * p.x + T[5] * p.y + T[6] * p.z + T[7],
          T[8] * p.x + T[9] * p.y + T[10] * p.z + T[11]};
}

Pose product(const Pose& a, const Pose& b) {
  Pose c{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      float sum = column == 3 ? a[4 * row + 3] : 0;
      for (std::size_t k = 0; k < 3; ++k) sum += a[4 * row + k] * b[4 * k + column];
      c[4 * row + column] = sum;
    }
  }
  return c;
}

Pose inverse(const Pose& T) {
  Pose i{};
  for (std::size_t row = 0; row < 3; ++row) {
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      i[4 * row + k] = T[4 * k + row];
      sum -= T[4 * k + row] * T[4 * k + 3];
    }
    i[4 * row + 3] = sum;
  }
  return i;
}

struct TsdfVoxel {
  float distance, weight;
};
struct ColorVoxel {
  std::array<std::uint8_t, 4> rgba;
  float weight;
};
static_assert(sizeof(TsdfVoxel) == 8 && sizeof(ColorVoxel) == 8);
struct Block {
  std::vector<TsdfVoxel> tsdf = std::vector<TsdfVoxel>(kVoxels, {0, 0});
  std::vector<ColorVoxel> color = std::vector<ColorVoxel>(kVoxels, {{127, 127, 127, 255}, 0});
};
using Index = std::tuple<int, int, int>;

struct Camera {
  float fx, fy, cx, cy;
  Pose T_base_camera;
};

struct Image {
  Camera camera;
  Pose T_map_base;
  int width = 0, height = 0;
  std::vector<std::uint16_t> depth_mm;
  std::vector<std::uint8_t> rgb;  // empty: no colour of the same size

  std::size_t pixel(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
  float depth_m(int x, int y) const { return static_cast<float>(depth_mm[pixel(x, y)]) * 1e-3F; }
  std::uint8_t color(int x, int y, std::size_t channel) const {
    return rgb.empty() ? std::uint8_t{0} : rgb[3 * pixel(x, y) + channel];
  }
  Point ray(int x, int y, float depth) const {
    return {(static_cast<float>(x) - camera.cx) / camera.fx * depth,
            (static_cast<float>(y) - camera.cy) / camera.fy * depth, depth};
  }
  Pose T_map_camera() const { return product(T_map_base, camera.T_base_camera); }
};

int block_of(float metres) { return static_cast<int>(std::floor(metres / kBlock_m)); }

class Volume {
 public:
  void fuse(const Image& image) {
    allocate(image);
    const Pose T_camera_map = inverse(image.T_map_camera());
    for (const Index& index : seen_) update(index, blocks_[index], image, T_camera_map);
    seen_.clear();
  }
  const std::map<Index, Block>& blocks() const { return blocks_; }

 private:
  // The blocks along every fourth ray, to just behind the surface.
  void allocate(const Image& image) {
    const Pose T = image.T_map_camera();
    std::map<Index, bool> seen;
    for (int y = 0; y < image.height; y += 4) {
      for (int x = 0; x < image.width; x += 4) {
        const float surface = image.depth_m(x, y);
        if (surface <= 0) continue;
        const float end = std::min(surface + kTruncation_m, kMostDepth_m);
        for (float depth = 0.1F; depth < end; depth += kBlock_m / 4) {
          const Point p = moved(T, image.ray(x, y, depth));
          seen[{block_of(p.x), block_of(p.y), block_of(p.z)}] = true;
        }
      }
    }
    for (const auto& [index, unused] : seen) seen_.push_back(index);
  }

  static void update(const Index& index, Block& block, const Image& image,
                     const Pose& T_camera_map) {
    const auto [bx, by, bz] = index;
    std::size_t i = 0;
    for (int x = 0; x < kSide; ++x) {
      for (int y = 0; y < kSide; ++y) {
        for (int z = 0; z < kSide; ++z, ++i) {
          const auto centre = [](int b, int v) {
            return (static_cast<float>(b * kSide + v) + 0.5F) * kVoxel_m;
          };
          const Point p = moved(T_camera_map, {centre(bx, x), centre(by, y), centre(bz, z)});
          if (p.z <= 0.05F || p.z > kMostDepth_m) continue;
          const int u =
              static_cast<int>(std::lround(image.camera.fx * p.x / p.z + image.camera.cx));
          const int v =
              static_cast<int>(std::lround(image.camera.fy * p.y / p.z + image.camera.cy));
          if (u < 0 || v < 0 || u >= image.width || v >= image.height) continue;
          const float surface = image.depth_m(u, v);
          if (surface <= 0 || surface > kMostDepth_m) continue;
          const float distance = surface - p.z;
          if (distance < -kTruncation_m) continue;
          observe(block, i, std::min(distance, kTruncation_m), 1 / (surface * surface), image, u,
                  v);
        }
      }
    }
  }

  static void observe(Block& block, std::size_t i, float distance, float weight, const Image& image,
                      int u, int v) {
    TsdfVoxel& voxel = block.tsdf[i];
    voxel.distance = (voxel.distance * voxel.weight + distance * weight) / (voxel.weight + weight);
    voxel.weight = std::min(voxel.weight + weight, kMostWeight);
    if (std::abs(distance) > kTruncation_m / 2 || image.rgb.empty()) return;
    ColorVoxel& color = block.color[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const float sum = static_cast<float>(color.rgba[c]) * color.weight +
                        static_cast<float>(image.color(u, v, c)) * weight;
      color.rgba[c] = static_cast<std::uint8_t>(std::lround(sum / (color.weight + weight)));
    }
    color.weight = std::min(color.weight + weight, kMostWeight);
  }

  std::map<Index, Block> blocks_;
  std::vector<Index> seen_;
};

[[noreturn]] void stop(const std::string& what) {
  std::fprintf(stderr, "fuse_depth: %s\n", what.c_str());
  std::exit(1);
}

// A connection and its statements.
class Database {
 public:
  Database(const std::string& path, int flags) {
    if (sqlite3_open_v2(path.c_str(), &db_, flags, nullptr) != SQLITE_OK)
      stop("cannot open " + path);
  }
  ~Database() { sqlite3_close(db_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  sqlite3_stmt* prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(db_, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
      stop(std::string(sqlite3_errmsg(db_)) + " in: " + sql);
    }
    return statement;
  }
  void run(const std::string& sql) {
    if (sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
      stop(std::string(sqlite3_errmsg(db_)) + " in: " + sql);
    }
  }

 private:
  sqlite3* db_ = nullptr;
};

std::vector<std::uint8_t> blob(sqlite3_stmt* row, int column) {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(row, column));
  return {data, data + sqlite3_column_bytes(row, column)};
}

// A zlib stream, then rows, columns and type.
std::vector<std::uint8_t> inflated(const std::vector<std::uint8_t>& packed, std::size_t bytes) {
  std::vector<std::uint8_t> out(bytes);
  uLongf size = bytes;
  if (packed.size() < 12 ||
      uncompress(out.data(), &size, packed.data(), packed.size() - 12) != Z_OK || size != bytes) {
    stop("a compressed matrix does not hold " + std::to_string(bytes) + " bytes");
  }
  return out;
}

std::map<int, Pose> optimised_poses(Database& db) {
  sqlite3_stmt* const row = db.prepare("SELECT opt_ids, opt_poses FROM Admin");
  if (sqlite3_step(row) != SQLITE_ROW) stop("no row in Admin");
  const auto packed_ids = blob(row, 0), packed_poses = blob(row, 1);
  std::array<std::int32_t, 2> shape{};
  if (packed_ids.size() < 12) stop("no optimised poses");
  std::memcpy(shape.data(), packed_ids.data() + packed_ids.size() - 12, sizeof shape);
  const std::size_t count = static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]);
  const auto ids = inflated(packed_ids, count * sizeof(std::int32_t));
  const auto poses = inflated(packed_poses, count * sizeof(Pose));
  std::map<int, Pose> all;
  for (std::size_t i = 0; i < count; ++i) {
    std::int32_t id = 0;
    Pose pose{};
    std::memcpy(&id, ids.data() + i * sizeof id, sizeof id);
    std::memcpy(pose.data(), poses.data() + i * sizeof pose, sizeof pose);
    all[id] = pose;
  }
  sqlite3_finalize(row);
  return all;
}

Camera read_camera(const std::vector<std::uint8_t>& bytes) {
  std::array<std::int32_t, 11> head{};
  if (bytes.size() < sizeof head) stop("a calibration is too short");
  std::memcpy(head.data(), bytes.data(), sizeof head);
  std::array<double, 9> K{};
  const auto bytes_of = [&](int first, int last) {
    std::size_t count = 0;
    for (int i = first; i < last; ++i)
      count += static_cast<std::size_t>(head[static_cast<std::size_t>(i)]);
    return count * sizeof(double);
  };
  const std::size_t at = sizeof head + bytes_of(6, 10);
  if (head[6] != 9 || head[10] != 12 || bytes.size() != at + sizeof(Pose)) {
    stop("a calibration is not of one camera with K and a local transform");
  }
  Camera camera{};
  std::memcpy(K.data(), bytes.data() + sizeof head, sizeof K);
  std::memcpy(camera.T_base_camera.data(), bytes.data() + at, sizeof(Pose));
  camera.fx = static_cast<float>(K[0]);
  camera.cx = static_cast<float>(K[2]);
  camera.fy = static_cast<float>(K[4]);
  camera.cy = static_cast<float>(K[5]);
  return camera;
}

// 16 bit grey.
void read_depth(const std::vector<std::uint8_t>& bytes, Image& image) {
  struct Source {
    const std::vector<std::uint8_t>& bytes;
    std::size_t at;
  } source{bytes, 0};
  png_structp png = png_create_read_struct(
      PNG_LIBPNG_VER_STRING, nullptr, [](png_structp, const char* what) { stop(what); }, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_read_fn(png, &source, [](png_structp reader, png_bytep out, png_size_t count) {
    auto& from = *static_cast<Source*>(png_get_io_ptr(reader));
    if (count > from.bytes.size() - from.at) png_error(reader, "a depth image ends early");
    std::memcpy(out, from.bytes.data() + from.at, count);
    from.at += count;
  });
  png_read_info(png, info);
  if (png_get_bit_depth(png, info) != 16 || png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY) {
    stop("a depth image is not 16 bit millimetres");
  }
  png_set_swap(png);
  image.width = static_cast<int>(png_get_image_width(png, info));
  image.height = static_cast<int>(png_get_image_height(png, info));
  image.depth_mm.resize(image.pixel(0, image.height));
  for (int y = 0; y < image.height; ++y) {
    png_read_row(png, reinterpret_cast<png_bytep>(&image.depth_mm[image.pixel(0, y)]), nullptr);
  }
  png_destroy_read_struct(&png, &info, nullptr);
}

void read_color(const std::vector<std::uint8_t>& bytes, Image& image) {
  if (bytes.empty()) return;
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, bytes.data(), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_RGB;
  jpeg_start_decompress(&jpeg);
  if (static_cast<int>(jpeg.output_width) == image.width &&
      static_cast<int>(jpeg.output_height) == image.height) {
    image.rgb.resize(3 * image.pixel(0, image.height));
    while (jpeg.output_scanline < jpeg.output_height) {
      JSAMPROW line = &image.rgb[3 * image.pixel(0, static_cast<int>(jpeg.output_scanline))];
      jpeg_read_scanlines(&jpeg, &line, 1);
    }
  }
  jpeg_destroy_decompress(&jpeg);
}

void write_layer(Database& db, const std::string& name, const std::map<Index, Block>& blocks,
                 const auto& voxels_of) {
  db.run("CREATE TABLE " + name +
         "_metadata(param_name TEXT, value_string TEXT, value_int INTEGER, value_float REAL);"
         "INSERT INTO " +
         name + "_metadata VALUES('block_size', NULL, NULL, " + std::to_string(kBlock_m) +
         ");CREATE TABLE " + name +
         "_data(index_x INTEGER, index_y INTEGER, index_z INTEGER, data BLOB)");
  sqlite3_stmt* const insert = db.prepare("INSERT INTO " + name + "_data VALUES(?, ?, ?, ?)");
  for (const auto& [index, block] : blocks) {
    const auto [x, y, z] = index;
    sqlite3_bind_int(insert, 1, x);
    sqlite3_bind_int(insert, 2, y);
    sqlite3_bind_int(insert, 3, z);
    sqlite3_bind_blob(insert, 4, voxels_of(block).data(), 8 * kVoxels, SQLITE_STATIC);
    if (sqlite3_step(insert) != SQLITE_DONE) stop("cannot insert a block");
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
}

// x y z rgb, every second pixel of every image.
class Cloud {
 public:
  void add(const Image& image) {
    const Pose T = image.T_map_camera();
    for (int y = 0; y < image.height; y += 2) {
      for (int x = 0; x < image.width; x += 2) {
        const float depth = image.depth_m(x, y);
        if (depth <= 0 || depth > kMostDepth_m) continue;
        const Point p = moved(T, image.ray(x, y, depth));
        std::uint32_t rgb = 0;
        for (std::size_t c = 0; c < 3; ++c) rgb = rgb << 8 | image.color(x, y, c);
        points_.push_back({p, rgb});
      }
    }
  }
  void write(const std::string& path) const {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) stop("cannot write " + path);
    std::fprintf(
        file,
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\n"
        "TYPE F F F U\nCOUNT 1 1 1 1\nWIDTH %zu\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %zu\n"
        "DATA binary\n",
        points_.size(), points_.size());
    const bool whole =
        std::fwrite(points_.data(), sizeof(Colored), points_.size(), file) == points_.size();
    if (std::fclose(file) != 0 || !whole) stop("cannot write " + path);
  }
  std::size_t size() const { return points_.size(); }

 private:
  struct Colored {
    Point at;
    std::uint32_t rgb;
  };
  std::vector<Colored> points_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: fuse_depth DATABASE OUT.nvblx OUT.pcd\n");
    return 2;
  }
  Database source(argv[1], SQLITE_OPEN_READONLY);
  const auto poses = optimised_poses(source);
  Volume volume;
  Cloud cloud;
  int images = 0;
  sqlite3_stmt* const row = source.prepare(
      "SELECT id, image, depth, calibration FROM Data WHERE length(depth) > 0 ORDER BY id");
  while (sqlite3_step(row) == SQLITE_ROW) {
    const auto pose = poses.find(sqlite3_column_int(row, 0));
    if (pose == poses.end()) continue;
    Image image;
    image.camera = read_camera(blob(row, 3));
    image.T_map_base = pose->second;
    read_depth(blob(row, 2), image);
    read_color(blob(row, 1), image);
    volume.fuse(image);
    cloud.add(image);
    ++images;
  }
  sqlite3_finalize(row);
  if (images == 0) stop(std::string(argv[1]) + " holds no depth images with optimised poses");

  std::remove(argv[2]);
  Database target(argv[2], SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  target.run("BEGIN");
  write_layer(
      target, "tsdf_layer", volume.blocks(), [](const Block& b) -> auto& { return b.tsdf; });
  write_layer(
      target, "color_layer", volume.blocks(), [](const Block& b) -> auto& { return b.color; });
  target.run("COMMIT");
  cloud.write(argv[3]);
  std::printf("%d depth images: %zu blocks of 8 x 8 x 8 voxels of %g m, %zu points\n", images,
              volume.blocks().size(), static_cast<double>(kVoxel_m), cloud.size());
}
