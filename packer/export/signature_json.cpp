// SPDX-License-Identifier: Apache-2.0
#include "packer/export/signature_json.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace zonepack::packer {
namespace {

class SignatureWriter {
 public:
  SignatureWriter(JsonLines& json, const SignatureRecord& record, PayloadMask packed)
      : json_(json),
        record_(record),
        features_((packed & mask_of(fb::PayloadKind::Features)) != 0) {}

  void write(std::string_view zone) {
    json_.begin_object();
    identity(zone);
    features();
    scan();
    grid();
    blob("image", record_.image);
    blob("depth", record_.depth);
    blob("depth_confidence", record_.depth_confidence);
    blob("calibration", record_.calibration);
    matrix("user_data", record_.user_data);
    global_descriptors();
    links();
    blob("velocity", record_.velocity);
    blob("gps", record_.gps);
    blob("env_sensors", record_.env_sensors);
    json_.end_object();
    json_.end_line();
  }

 private:
  void integer(std::string_view key, std::int64_t value) {
    json_.key(key);
    json_.integer(value);
  }

  void number(std::string_view key, double value) {
    json_.key(key);
    json_.number(value);
  }

  void blob(std::string_view key, const Bytes& bytes) {
    json_.key(key);
    bytes.empty() ? json_.null() : json_.base64(bytes);
  }

  void transform(std::string_view key, const std::optional<Transform>& value) {
    json_.key(key);
    value ? json_.numbers(*value) : json_.null();
  }

  // The bytes under `key`; rows, columns and OpenCV type under KEY_shape.
  void matrix(const std::string& key, const Matrix& value) {
    json_.key(key);
    json_.base64(value.data);
    json_.key(key + "_shape");
    json_.begin_array();
    json_.integer(value.rows);
    json_.integer(value.cols);
    json_.integer(value.type);
    json_.end_array();
  }

  void matrix(const std::string& key, const std::optional<Matrix>& value) {
    if (value) return matrix(key, *value);
    json_.key(key);
    json_.null();
    json_.key(key + "_shape");
    json_.null();
  }

  void identity(std::string_view zone) {
    json_.key("zone");
    json_.text(zone);
    integer("id", record_.id);
    integer("map_id", record_.map_id);
    integer("weight", record_.weight);
    number("stamp", record_.stamp);
    json_.key("label");
    record_.label.empty() ? json_.null() : json_.text(record_.label);
    transform("pose", record_.pose);
    transform("odometry_pose", record_.odometry_pose);
    transform("ground_truth_pose", record_.ground_truth_pose);
  }

  template <typename Fn>
  void for_each_feature(std::string_view key, Fn&& fn) {
    json_.key(key);
    if (!features_) return json_.null();
    json_.begin_array();
    for (std::size_t i = 0; i < record_.features.count; ++i) fn(i);
    json_.end_array();
  }

  void features() {
    const Features& f = record_.features;
    for_each_feature("keypoints", [&](std::size_t i) {
      json_.begin_array();
      for (const float v : {f.x[i], f.y[i], f.size[i], f.angle[i], f.response[i]}) json_.number(v);
      json_.integer(f.octave[i]);
      json_.end_array();
    });
    for_each_feature("points",
                     [&](std::size_t i) { point(f.point_x[i], f.point_y[i], f.point_z[i]); });
    for_each_feature("word_ids", [&](std::size_t i) { json_.integer(f.word_id[i]); });
    const bool some = f.descriptor_type != Features::DescriptorType::kNone;
    json_.key("descriptor_type");
    some ? json_.text(f.descriptor_type == Features::DescriptorType::kU8 ? "u8" : "f32")
         : json_.null();
    json_.key("descriptor_dim");
    some ? json_.integer(f.descriptor_dim) : json_.null();
    json_.key("descriptors");
    some ? json_.base64(f.descriptors) : json_.null();
  }

  // A NaN stands for NULL in the database.
  void point(float x, float y, float z) {
    if (std::isnan(x) && std::isnan(y) && std::isnan(z)) return json_.null();
    json_.begin_array();
    for (const float v : {x, y, z}) std::isnan(v) ? json_.null() : json_.number(v);
    json_.end_array();
  }

  void scan() {
    json_.key("scan");
    if (!record_.scan) return json_.null();
    const Scan& s = *record_.scan;
    json_.begin_object();
    integer("format", s.format);
    number("range_min", s.range_min);
    number("range_max", s.range_max);
    number("angle_min", s.angle_min);
    number("angle_max", s.angle_max);
    number("angle_increment", s.angle_increment);
    number("max_points", s.max_points);
    json_.key("local_transform");
    const bool none = std::ranges::all_of(s.local_transform, [](float v) { return v == 0; });
    none ? json_.null() : json_.numbers(s.local_transform);
    matrix("data", s.data);
    json_.end_object();
  }

  void grid() {
    json_.key("grid");
    if (!record_.grid) return json_.null();
    const Grid& g = *record_.grid;
    json_.begin_object();
    number("cell_size", g.cell_size);
    json_.key("view_point");
    json_.numbers(g.view_point);
    matrix("ground", g.ground);
    matrix("obstacle", g.obstacle);
    matrix("empty", g.empty);
    json_.end_object();
  }

  void global_descriptors() {
    json_.key("global_descriptors");
    if (!features_) return json_.null();
    json_.begin_array();
    for (const GlobalDescriptor& descriptor : record_.global_descriptors) {
      json_.begin_object();
      integer("type", descriptor.type);
      matrix("info", descriptor.info);
      matrix("data", descriptor.data);
      json_.end_object();
    }
    json_.end_array();
  }

  void links() {
    json_.key("links");
    json_.begin_array();
    for (const Link& link : record_.links) {
      json_.begin_object();
      integer("to", link.to);
      integer("type", link.type);
      transform("transform", link.transform);
      json_.key("information");
      link.information.empty() ? json_.null() : json_.numbers(link.information);
      matrix("user_data", link.user_data);
      json_.end_object();
    }
    json_.end_array();
  }

  JsonLines& json_;
  const SignatureRecord& record_;
  bool features_;
};

}  // namespace

void write_signature(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                     PayloadMask packed) {
  SignatureWriter(json, record, packed).write(zone);
}

}  // namespace zonepack::packer
