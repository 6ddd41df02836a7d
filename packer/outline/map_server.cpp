// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/map_server.hpp"

#include <yaml-cpp/yaml.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>

#include "packer/outline/plan_picture.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kMostYamlBytes = 65536;
constexpr double kMostOrigin_m = 1e6;

class GridFileReader {
 public:
  explicit GridFileReader(const std::filesystem::path& yaml) : file_(yaml) {}

  GridFile read() {
    parse();
    GridFile map;
    map.image.resolution_m = number("resolution", std::nullopt);
    if (!(map.image.resolution_m >= 1e-3 && map.image.resolution_m <= 10)) {
      refuse("resolution", "is " + text("resolution") + ", expected 0.001 to 10 metres a pixel");
    }
    const std::array<double, 3> origin = read_origin();
    map.image.x_min_m = origin[0];
    map.image.y_min_m = origin[1];
    map.yaw_rad = origin[2];
    read_rule();
    std::filesystem::path image = text("image");
    if (image.is_relative()) image = file_.parent_path() / image;
    map.image_file = image.string();
    fill(map.image, read_plan_picture(map.image_file, kMostServedCells));
    return map;
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& why) const {
    throw std::runtime_error(file_.string() + ": " + (key.empty() ? "" : "key '" + key + "' ") +
                             why);
  }

  void parse() {
    errno = 0;
    std::ifstream in(file_, std::ios::binary);
    std::string yaml(kMostYamlBytes + 1, '\0');
    in.read(yaml.data(), static_cast<std::streamsize>(yaml.size()));
    yaml.resize(static_cast<std::size_t>(in.gcount()));
    if (yaml.empty() && errno != 0) {
      refuse("", std::string("cannot read the file: ") + std::strerror(errno));
    }
    if (yaml.size() > kMostYamlBytes) {
      refuse("", "longer than 65536 bytes; expected the YAML file of a map_server map");
    }
    const std::string expected =
        "; expected the YAML file of a map_server map, with image, resolution and origin";
    try {
      root_ = YAML::Load(yaml);
    } catch (const YAML::Exception& error) {
      refuse("", "line " + std::to_string(error.mark.line + 1) + ": " + error.msg + expected);
    }
    if (!root_.IsMap()) refuse("", "is no list of keys" + expected);
  }

  std::string text(const std::string& key) const {
    const YAML::Node node = root_[key];
    if (!node) refuse(key, "is missing");
    if (!node.IsScalar() || node.Scalar().empty()) refuse(key, "is no single value");
    return node.Scalar();
  }

  static std::optional<double> number_of(const YAML::Node& node) {
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value)) return std::nullopt;
    if (!std::isfinite(value)) return std::nullopt;
    return value;
  }

  double number(const std::string& key, std::optional<double> otherwise) const {
    if (otherwise && !root_[key]) return *otherwise;
    const std::string value = text(key);
    if (const auto parsed = number_of(root_[key])) return *parsed;
    refuse(key, "is '" + value + "', expected a number");
  }

  std::array<double, 3> read_origin() const {
    const YAML::Node node = root_["origin"];
    if (!node) refuse("origin", "is missing");
    std::array<double, 3> origin{};
    bool fits = node.IsSequence() && node.size() == 3;
    for (std::size_t i = 0; fits && i < 3; ++i) {
      const auto value = number_of(node[i]);
      fits = value && std::abs(*value) <= kMostOrigin_m;
      origin[i] = value.value_or(0);
    }
    if (!fits) refuse("origin", "must be [x, y, yaw], three numbers in metres and radians");
    return origin;
  }

  void read_rule() {
    occupied_ = number("occupied_thresh", 0.65);
    free_ = number("free_thresh", 0.25);
    if (!(free_ >= 0 && free_ <= occupied_ && occupied_ <= 1)) {
      refuse("free_thresh", "is " + std::to_string(free_) + " and occupied_thresh is " +
                                std::to_string(occupied_) +
                                ", expected 0 <= free_thresh <= occupied_thresh <= 1");
    }
    const std::string negate = root_["negate"] ? text("negate") : "0";
    if (negate != "0" && negate != "1" && negate != "true" && negate != "false") {
      refuse("negate", "is '" + negate + "', expected 0 or 1");
    }
    negate_ = negate == "1" || negate == "true";
    mode_ = root_["mode"] ? text("mode") : "trinary";
    if (mode_ != "trinary" && mode_ != "scale" && mode_ != "raw") {
      refuse("mode", "is '" + mode_ + "', expected trinary, scale or raw");
    }
  }

  Cell cell_of(std::uint8_t grey, std::uint8_t opacity) const {
    if (mode_ == "scale" && opacity < 255) return Cell::kUnknown;
    // How likely the cell is occupied. A raw map holds it in percent, more than 100 is unknown.
    double occupied = (negate_ ? grey : 255 - grey) / 255.0;
    if (mode_ == "raw") {
      if (grey > 100) return Cell::kUnknown;
      occupied = grey / 100.0;
    }
    if (occupied > occupied_) return Cell::kOccupied;
    return occupied < free_ ? Cell::kFree : Cell::kUnknown;
  }

  void fill(MapImage& map, const PlanPicture& grey) const {
    map.width = grey.width;
    map.height = grey.height;
    map.cells.reserve(grey.pixels.size());
    for (std::size_t row = grey.height; row-- > 0;) {
      for (std::size_t column = 0; column < grey.width; ++column) {
        const std::size_t at = row * grey.width + column;
        map.cells.push_back(
            cell_of(grey.pixels[at], grey.opacity.empty() ? 255 : grey.opacity[at]));
      }
    }
  }

  const std::filesystem::path file_;
  YAML::Node root_;
  double occupied_ = 0, free_ = 0;
  bool negate_ = false;
  std::string mode_;
};

}  // namespace

GridFile read_grid_file(const std::filesystem::path& yaml) { return GridFileReader(yaml).read(); }

MapDrawing drawing_of(GridFile map) {
  MapDrawing drawing;
  drawing.image = std::move(map.image);
  drawing.yaw_rad = map.yaw_rad;
  drawing.source = map.image_file;
  return drawing;
}

}  // namespace zonepack::packer
