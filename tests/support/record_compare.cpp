// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <optional>

#include "tests/support/signature_recipe.hpp"

namespace zonepack::test_support {
namespace {

using packer::Matrix;

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

template <typename T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

bool same(const Matrix& a, const Matrix& b) {
  return a.rows == b.rows && a.cols == b.cols && a.type == b.type && a.data == b.data;
}

bool same(const packer::Transform& a, const packer::Transform& b) { return same_bits(a, b); }

template <typename T>
bool same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

// Collects the first name whose values differ.
class Difference {
 public:
  void note(const std::string& name, bool equal) {
    if (!equal && name_.empty()) name_ = name;
  }
  std::string name() const { return name_; }

 private:
  std::string name_;
};

void compare(const packer::Features& a, const packer::Features& b, Difference& d) {
  d.note("features.count", a.count == b.count);
  d.note("features.x", same_bits(a.x, b.x));
  d.note("features.y", same_bits(a.y, b.y));
  d.note("features.size", same_bits(a.size, b.size));
  d.note("features.angle", same_bits(a.angle, b.angle));
  d.note("features.response", same_bits(a.response, b.response));
  d.note("features.octave", a.octave == b.octave);
  d.note("features.word_id", a.word_id == b.word_id);
  d.note("features.point_x", same_bits(a.point_x, b.point_x));
  d.note("features.point_y", same_bits(a.point_y, b.point_y));
  d.note("features.point_z", same_bits(a.point_z, b.point_z));
  d.note("features.descriptor_type", a.descriptor_type == b.descriptor_type);
  d.note("features.descriptor_dim", a.descriptor_dim == b.descriptor_dim);
  d.note("features.descriptors", a.descriptors == b.descriptors);
}

void compare(const packer::Scan& a, const packer::Scan& b, Difference& d) {
  d.note("scan.format", a.format == b.format);
  d.note("scan.range", same_bits(a.range_min, b.range_min) && same_bits(a.range_max, b.range_max));
  d.note("scan.angles", same_bits(a.angle_min, b.angle_min) &&
                            same_bits(a.angle_max, b.angle_max) &&
                            same_bits(a.angle_increment, b.angle_increment));
  d.note("scan.max_points", same_bits(a.max_points, b.max_points));
  d.note("scan.local_transform", same(a.local_transform, b.local_transform));
  d.note("scan.data", same(a.data, b.data));
}

void compare(const packer::Grid& a, const packer::Grid& b, Difference& d) {
  d.note("grid.cell_size", same_bits(a.cell_size, b.cell_size));
  d.note("grid.view_point", same_bits(a.view_point, b.view_point));
  d.note("grid.ground", same(a.ground, b.ground));
  d.note("grid.obstacle", same(a.obstacle, b.obstacle));
  d.note("grid.empty", same(a.empty, b.empty));
}

void compare(const std::vector<packer::Link>& a, const std::vector<packer::Link>& b,
             Difference& d) {
  d.note("links.size", a.size() == b.size());
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    const std::string name = "links[" + std::to_string(i) + "].";
    d.note(name + "to", a[i].to == b[i].to);
    d.note(name + "type", a[i].type == b[i].type);
    d.note(name + "transform", same(a[i].transform, b[i].transform));
    d.note(name + "information", same_bits(a[i].information, b[i].information));
    d.note(name + "user_data", same(a[i].user_data, b[i].user_data));
  }
}

void compare(const packer::BlockCube& a, const packer::BlockCube& b, Difference& d) {
  d.note("blocks.index", a.index == b.index);
  d.note("blocks.layers_info", a.layers_info == b.layers_info);
  for (std::size_t i = 0; i < a.layers.size(); ++i) {
    const std::string name = "blocks.layers[" + std::to_string(i) + "].";
    d.note(name + "place", a.layers[i].place == b.layers[i].place);
    d.note(name + "row", a.layers[i].row == b.layers[i].row);
    d.note(name + "voxels", a.layers[i].voxels == b.layers[i].voxels);
  }
}

}  // namespace

std::string first_difference(const packer::SignatureRecord& a, const packer::SignatureRecord& b) {
  Difference d;
  d.note("id", a.id == b.id);
  d.note("map_id", a.map_id == b.map_id);
  d.note("weight", a.weight == b.weight);
  d.note("stamp", same_bits(a.stamp, b.stamp));
  d.note("label", a.label == b.label);
  d.note("pose", same(a.pose, b.pose));
  d.note("odometry_pose", same(a.odometry_pose, b.odometry_pose));
  d.note("ground_truth_pose", same(a.ground_truth_pose, b.ground_truth_pose));
  d.note("velocity", a.velocity == b.velocity);
  d.note("gps", a.gps == b.gps);
  d.note("env_sensors", a.env_sensors == b.env_sensors);
  d.note("calibration", a.calibration == b.calibration);
  compare(a.features, b.features, d);
  d.note("global_descriptors.size", a.global_descriptors.size() == b.global_descriptors.size());
  for (std::size_t i = 0; i < a.global_descriptors.size() && i < b.global_descriptors.size(); ++i) {
    const auto &left = a.global_descriptors[i], &right = b.global_descriptors[i];
    d.note("global_descriptors[" + std::to_string(i) + "]",
           left.type == right.type && same(left.info, right.info) && same(left.data, right.data));
  }
  d.note("scan", a.scan.has_value() == b.scan.has_value());
  if (a.scan && b.scan) compare(*a.scan, *b.scan, d);
  d.note("grid", a.grid.has_value() == b.grid.has_value());
  if (a.grid && b.grid) compare(*a.grid, *b.grid, d);
  d.note("image", a.image == b.image);
  d.note("depth", a.depth == b.depth);
  d.note("depth_confidence", a.depth_confidence == b.depth_confidence);
  d.note("user_data", same(a.user_data, b.user_data));
  d.note("blocks", a.blocks.has_value() == b.blocks.has_value());
  if (a.blocks && b.blocks) compare(*a.blocks, *b.blocks, d);
  compare(a.links, b.links, d);
  return d.name();
}

}  // namespace zonepack::test_support
