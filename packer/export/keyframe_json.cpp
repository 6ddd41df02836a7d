// SPDX-License-Identifier: Apache-2.0
#include "packer/export/keyframe_json.hpp"

#include <cmath>

namespace zonepack::packer {
namespace {

template <typename Write>
void write_list(JsonLines& json, std::string_view key, bool packed, std::size_t count,
                Write&& write) {
  json.key(key);
  if (!packed) return json.null();
  json.begin_array();
  for (std::size_t i = 0; i < count; ++i) write(i);
  json.end_array();
}

void write_features(JsonLines& json, const Features& f, bool packed) {
  write_list(json, "undist_keypts", packed, f.count, [&](std::size_t i) {
    json.begin_array();
    for (const float v : {f.x[i], f.y[i], f.size[i], f.angle[i], f.response[i]}) json.number(v);
    json.integer(f.octave[i]);
    json.end_array();
  });
  write_list(json, "lm_ids", packed, f.count, [&](std::size_t i) { json.integer(f.word_id[i]); });
  write_list(json, "points", packed, f.count, [&](std::size_t i) {
    if (std::isnan(f.point_x[i])) return json.null();
    json.begin_array();
    for (const float v : {f.point_x[i], f.point_y[i], f.point_z[i]}) json.number(v);
    json.end_array();
  });
  json.key("descs");
  packed ? json.base64(f.descriptors) : json.null();
}

}  // namespace

void write_keyframe(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                    PayloadMask packed) {
  json.begin_object();
  json.key("zone");
  json.text(zone);
  json.key("keyframe");
  json.integer(record.id);
  json.key("ts");
  json.number(record.stamp);
  json.key("pose");
  record.pose ? json.numbers(*record.pose) : json.null();
  write_features(json, record.features, (packed & mask_of(fb::PayloadKind::Features)) != 0);
  json.key("calibration");
  record.calibration.empty() ? json.null() : json.base64(record.calibration);
  std::int32_t parent = -1;
  for (const Link& link : record.links) {
    if (link.type == kNeighbourLink) parent = link.to;
  }
  json.key("span_parent");
  json.integer(parent);
  json.key("loop_edges");
  json.begin_array();
  for (const Link& link : record.links) {
    if (link.type == kGlobalClosureLink) json.integer(link.to);
  }
  json.end_array();
  json.end_object();
  json.end_line();
}

}  // namespace zonepack::packer
