// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/cloud_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

#include "packer/sources/cloud/pcd_stream.hpp"
#include "packer/sources/cloud/spool.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLongestText = std::uintmax_t{64} << 20;
constexpr std::array<const char*, 2> kAutowareTexts = {"pointcloud_map_metadata.yaml",
                                                       "pointcloud_data_metadata.yaml"};

std::string text_of(const fs::path& path) {
  std::error_code error;
  if (fs::file_size(path, error) > kLongestText && !error) {
    throw std::runtime_error(path.string() + ": is longer than 64 MiB");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path.string() + ": cannot be read: " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(in), {}};
}

// Every tile is a file of its own, read when it is wanted.
class CloudFiles : public CloudMap {
 public:
  void read(const CloudTile& tile, TilePoints& into) const override {
    const OneFile& file = files_[static_cast<std::size_t>(tile.id - 1)];
    const std::unique_ptr<PointStream> stream = open(file.path);
    read_points(*stream, origin_of(file), into);
    if (into.size() != tile.points) {
      throw std::runtime_error(file.path + ": changed while it was read; try again");
    }
  }

  void require_unchanged() const override {
    for (const OneFile& file : files_) {
      std::error_code error;
      if (fs::file_size(file.path, error) == file.bytes && !error &&
          fs::last_write_time(file.path, error) == file.written && !error) {
        continue;
      }
      throw std::runtime_error(file.path + ": changed while it was read; try again");
    }
  }

 protected:
  struct OneFile {
    std::string path;
    std::uintmax_t bytes = 0;
    fs::file_time_type written;
    std::array<double, 3> corner{};  // subtracted from float64 coordinates
  };
  using Pose = std::array<double, 12>;

  virtual std::unique_ptr<PointStream> open(const std::string& path) const = 0;

  // The tile of a file: how many points, and which of them is nearest to their middle. `pose`: of
  // the file's frame in the map.
  void add(const fs::path& path, const std::string& label, double stamp_s, const Pose& pose,
           const std::array<double, 3>& corner) {
    OneFile& file = files_.emplace_back();
    file.path = path.string();
    file.bytes = fs::file_size(path);
    file.written = fs::last_write_time(path);
    const Middle middle = middle_of(file.path);
    if (middle.points == 0) {
      warnings.push_back(file.path + ": has no point with a place; it is left out");
      files_.pop_back();
      return;
    }
    file.corner = corner;
    CloudTile& tile = tiles.emplace_back();
    tile.id = static_cast<std::int32_t>(tiles.size());
    tile.label = label;
    tile.stamp_s = stamp_s;
    tile.points = middle.points;
    points += middle.points;
    place(tile, pose, middle.nearest, origin_of(file));
  }

  // The base stands at a point of the tile, turned as the file's frame is.
  static void place(CloudTile& tile, const Pose& T, const std::array<double, 3>& p,
                    const std::array<double, 3>& origin) {
    for (std::size_t row = 0; row < 3; ++row) {
      const double* const r = &T[row * 4];
      tile.base[row] = r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
      for (std::size_t column = 0; column < 3; ++column) {
        tile.T_map_base[row * 4 + column] = static_cast<float>(r[column]);
        tile.T_base_points[row * 4 + column] = row == column ? 1.0F : 0.0F;
      }
      tile.T_map_base[row * 4 + 3] = static_cast<float>(tile.base[row]);
      tile.T_base_points[row * 4 + 3] = static_cast<float>(origin[row] - p[row]);
    }
  }

  void finish(const std::string& name) {
    if (tiles.empty()) {
      throw std::runtime_error(name + ": holds no tile with points; expected " + version +
                               " files");
    }
    source_bytes = points * fields.words() * 4;
    notes.push_back(std::to_string(points) + " points in " + std::to_string(tiles.size()) +
                    (tiles.size() == 1 ? " file" : " files"));
  }

  std::array<double, 3> origin_of(const OneFile& file) const {
    return fields.wide ? file.corner : std::array<double, 3>{};
  }

  std::vector<OneFile> files_;

 private:
  struct Middle {
    std::uint64_t points = 0;
    std::array<double, 3> nearest{};
  };

  Middle middle_of(const std::string& path) {
    Middle middle;
    std::array<double, 3> sum{};
    std::uint64_t nowhere = 0;
    {
      const auto stream = open(path);
      take_fields(path, stream->fields());
      for (CloudPoint p; stream->next(p);) {
        if (!is_place(p)) {
          ++nowhere;
          continue;
        }
        ++middle.points;
        sum[0] += p.x;
        sum[1] += p.y;
        sum[2] += p.z;
      }
    }
    if (nowhere > 0) {
      warnings.push_back(path + ": " + std::to_string(nowhere) +
                         " points are not finite or over 10,000 km away; they are left out");
    }
    double least = std::numeric_limits<double>::max();
    const auto n = static_cast<double>(middle.points);
    const auto stream = open(path);
    for (CloudPoint p; stream->next(p);) {
      if (!is_place(p)) continue;
      const double dx = p.x - sum[0] / n, dy = p.y - sum[1] / n, dz = p.z - sum[2] / n;
      const double square = dx * dx + dy * dy + dz * dz;
      if (square >= least) continue;
      least = square;
      middle.nearest = {p.x, p.y, p.z};
    }
    return middle;
  }

  void take_fields(const std::string& path, const CloudFields& of_file) {
    if (files_.size() == 1 && tiles.empty()) {
      fields = of_file;
    } else if (!(fields == of_file)) {
      throw std::runtime_error(path + ": has other fields than " + files_.front().path +
                               "; all files of a map have the same");
    }
  }
};

// An Autoware tile's corner, by its file name.
std::map<std::string, std::array<double, 2>> corners_in(const fs::path& text) {
  std::map<std::string, std::array<double, 2>> corners;
  std::istringstream in(text_of(text));
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::size_t colon = line.find(':');
    if (colon == line.npos || line.starts_with('#')) continue;
    std::string key = line.substr(0, colon);
    std::erase_if(key, [](char c) { return c == '"' || c == '\'' || c == ' '; });
    if (!key.ends_with(".pcd")) continue;
    std::string values = line.substr(colon + 1);
    std::ranges::replace_if(
        values, [](char c) { return c == '[' || c == ']' || c == ',' || c == '\r'; }, ' ');
    std::istringstream two(values);
    std::array<double, 2> corner{};
    std::string rest;
    if (!(two >> corner[0] >> corner[1]) || two >> rest) {
      throw std::runtime_error(text.string() + ", line " + std::to_string(number) +
                               ": expected the corner of the tile as [x, y]");
    }
    corners[key] = corner;
  }
  return corners;
}

class AutowareTiles : public CloudFiles {
 public:
  explicit AutowareTiles(const fs::path& folder) {
    version = "autoware";
    fs::path text;
    for (const char* name : kAutowareTexts) {
      if (fs::exists(folder / name)) text = folder / name;
    }
    const auto corners = corners_in(text);
    for (const auto& [name, corner] : corners) {
      const fs::path tile = folder / name;
      if (name.find('/') != name.npos || !fs::is_regular_file(tile)) {
        throw std::runtime_error(text.string() + ": names the tile " + name +
                                 ", which is not in the folder; copy the map again");
      }
      add(tile, name, 0, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, {corner[0], corner[1], 0});
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(".pcd") && !corners.contains(name)) {
        warnings.push_back(entry.path().string() + ": is not named in " + text.filename().string() +
                           ", so it is left out");
      }
    }
    std::ranges::sort(warnings);
    finish(folder.string());
  }

 private:
  std::unique_ptr<PointStream> open(const std::string& path) const override {
    return open_pcd(path);
  }
};

// float32 x, y, z, packed.
class CompactStream : public PointStream {
 public:
  explicit CompactStream(const std::string& path) : name_(path), file_(open_file(path)) {
    const std::uintmax_t bytes = fs::file_size(path);
    if (bytes % 12 != 0) {
      throw std::runtime_error(path + ": expected points of 12 bytes, found " +
                               std::to_string(bytes) + " bytes; copy the dump again");
    }
    points_ = bytes / 12;
  }
  const CloudFields& fields() const noexcept override { return fields_; }
  std::uint64_t size() const noexcept override { return points_; }
  bool next(CloudPoint& point) override {
    if (read_ == points_) return false;
    std::array<float, 3> p{};
    if (std::fread(p.data(), 4, 3, file_.get()) != 3) {
      throw std::runtime_error(name_ + ": ends too early; copy the dump again");
    }
    ++read_;
    point = {p[0], p[1], p[2], 0, 0, 0};
    return true;
  }

 private:
  std::string name_;
  File file_;
  CloudFields fields_;
  std::uint64_t points_ = 0, read_ = 0;
};

class GlimDump : public CloudFiles {
 public:
  explicit GlimDump(const fs::path& folder) {
    version = "glim";
    std::vector<fs::path> submaps;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (entry.is_directory() && fs::exists(entry.path() / "data.txt"))
        submaps.push_back(entry.path());
    }
    std::ranges::sort(submaps);
    for (const fs::path& submap : submaps) {
      const std::string text = text_of(submap / "data.txt");
      const fs::path cloud = submap / "points_compact.bin";
      if (!fs::is_regular_file(cloud)) {
        throw std::runtime_error(cloud.string() + ": is missing; copy the dump again");
      }
      add(cloud, submap.filename().string(), stamp_in(text), pose_in(text, submap / "data.txt"),
          {});
    }
    finish(folder.string());
  }

 private:
  std::unique_ptr<PointStream> open(const std::string& path) const override {
    return std::make_unique<CompactStream>(path);
  }

  static Pose pose_in(const std::string& text, const fs::path& file) {
    const auto fail = [&file](const char* problem) {
      throw std::runtime_error(file.string() + ": T_world_origin: " + problem);
    };
    const std::size_t at = text.find("T_world_origin:");
    if (at == text.npos) fail("expected 16 numbers, found no such key");
    std::istringstream in(text.substr(at + 15));
    std::array<double, 16> m{};
    for (double& value : m) {
      if (!(in >> value) || !std::isfinite(value)) fail("expected 16 numbers, row by row");
    }
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        const double dot =
            m[4 * a] * m[4 * b] + m[4 * a + 1] * m[4 * b + 1] + m[4 * a + 2] * m[4 * b + 2];
        if (std::abs(dot - (a == b ? 1 : 0)) > 0.01)
          fail("expected a rotation in its first three columns");
      }
      if (std::abs(m[4 * a + 3]) >= 1e7) fail("expected a place within 10,000 km");
    }
    Pose pose{};
    std::copy_n(m.begin(), 12, pose.begin());
    return pose;
  }

  // Of the submap's first frame; 0 where the text names none.
  static double stamp_in(const std::string& text) {
    const std::size_t at = text.find("stamp:");
    double stamp = 0;
    if (at != text.npos) std::istringstream(text.substr(at + 6, 40)) >> stamp;
    return std::isfinite(stamp) ? stamp : 0;
  }
};

}  // namespace

bool is_autoware_tiles(const fs::path& folder) {
  std::error_code error;
  return std::ranges::any_of(
      kAutowareTexts, [&](const char* name) { return fs::is_regular_file(folder / name, error); });
}

std::unique_ptr<CloudMap> open_autoware_tiles(const fs::path& folder) {
  return std::make_unique<AutowareTiles>(folder);
}

bool is_glim_dump(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "graph.txt", error) &&
         (fs::is_directory(folder / "000000", error) ||
          fs::exists(folder / "traj_lidar.txt", error));
}

std::unique_ptr<CloudMap> open_glim_dump(const fs::path& folder) {
  return std::make_unique<GlimDump>(folder);
}

}  // namespace zonepack::packer
