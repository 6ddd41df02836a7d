// SPDX-License-Identifier: Apache-2.0
#include "packer/export/cloud_json.hpp"

#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace zonepack::packer {
namespace {

// Of the scan's format, as packer/sources/cloud writes it.
std::vector<const char*> fields_of(std::int32_t format) {
  std::vector<const char*> fields = {"x", "y", "z"};
  const std::int32_t mask = format >= 256 ? format - 256 : format - 5;
  if ((mask & 1) != 0) fields.push_back("intensity");
  if ((mask & 2) != 0) fields.push_back("rgb");
  if ((mask & 4) != 0) fields.push_back("ring");
  return fields;
}

// Without the rounding of a product: the base is turned as the points are.
Transform points_in_map(const Transform& T_map_base, const Transform& T_base_points) {
  Transform out = T_map_base;
  for (std::size_t row = 0; row < 3; ++row) {
    double sum = T_map_base[row * 4 + 3];
    for (std::size_t k = 0; k < 3; ++k) {
      sum += static_cast<double>(T_map_base[row * 4 + k]) *
             static_cast<double>(T_base_points[k * 4 + 3]);
    }
    out[row * 4 + 3] = static_cast<float>(sum);
  }
  return out;
}

void write_points(JsonLines& json, const Scan& scan, const std::vector<const char*>& fields) {
  const std::size_t words = fields.size();
  const Bytes& data = scan.data.data;
  if (data.size() % (words * 4) != 0) throw std::runtime_error("points are not whole");
  json.begin_array();
  for (std::size_t at = 0; at < data.size(); at += words * 4) {
    json.begin_array();
    for (std::size_t i = 0; i < words; ++i) {
      const bool colour = std::strcmp(fields[i], "rgb") == 0;
      float value;
      std::uint32_t bits;
      std::memcpy(&value, data.data() + at + i * 4, 4);
      std::memcpy(&bits, data.data() + at + i * 4, 4);
      colour ? json.integer(bits) : json.number(value);
    }
    json.end_array();
  }
  json.end_array();
}

}  // namespace

void write_tile(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                PayloadMask packed) {
  const bool some = (packed & mask_of(fb::PayloadKind::Scan)) != 0 && record.scan.has_value();
  json.begin_object();
  json.key("zone");
  json.text(zone);
  json.key("tile");
  json.integer(record.id);
  json.key("file");
  record.label.empty() ? json.null() : json.text(record.label);
  json.key("T_map_base");
  record.pose ? json.numbers(*record.pose) : json.null();
  json.key("T_map_points");
  some&& record.pose ? json.numbers(points_in_map(*record.pose, record.scan->local_transform))
                     : json.null();
  json.key("fields");
  const std::vector<const char*> fields = fields_of(some ? record.scan->format : 5);
  if (some) {
    json.begin_array();
    for (const char* field : fields) json.text(field);
    json.end_array();
  } else {
    json.null();
  }
  json.key("points");
  some ? write_points(json, *record.scan, fields) : json.null();
  json.end_object();
  json.end_line();
}

}  // namespace zonepack::packer
