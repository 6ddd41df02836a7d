// SPDX-License-Identifier: Apache-2.0
#include "tests/support/record_text.hpp"

#include <cmath>
#include <span>

#include "runtime/pack_format/file/checksum.hpp"

namespace zonepack::test_support {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  return value;
}

template <typename Numbers>
Json numbers(const Numbers& values) {
  Json json = Json::array();
  for (const auto value : values) json.push_back(number(value));
  return json;
}

Json hex(const packer::Bytes& bytes) {
  return to_hex(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

Json transform(const std::optional<packer::Transform>& T) { return T ? numbers(*T) : Json(); }

Json matrix(const packer::Matrix& m) {
  return {{"rows", m.rows}, {"cols", m.cols}, {"type", m.type}, {"data", hex(m.data)}};
}
Json matrix(const std::optional<packer::Matrix>& m) { return m ? matrix(*m) : Json(); }

Json features(const packer::Features& f) {
  Json json;
  json["count"] = f.count;
  json["x"] = numbers(f.x);
  json["y"] = numbers(f.y);
  json["size"] = numbers(f.size);
  json["angle"] = numbers(f.angle);
  json["response"] = numbers(f.response);
  json["octave"] = f.octave;
  json["word_id"] = f.word_id;
  json["point_x"] = numbers(f.point_x);
  json["point_y"] = numbers(f.point_y);
  json["point_z"] = numbers(f.point_z);
  json["descriptor_type"] = static_cast<int>(f.descriptor_type);
  json["descriptor_dim"] = f.descriptor_dim;
  json["descriptors"] = hex(f.descriptors);
  return json;
}

Json scan(const packer::Scan& s) {
  Json json;
  json["format"] = s.format;
  json["info"] = numbers(std::vector<float>{s.range_min, s.range_max, s.angle_min, s.angle_max,
                                            s.angle_increment, s.max_points});
  json["local_transform"] = numbers(s.local_transform);
  json["data"] = matrix(s.data);
  return json;
}

Json grid(const packer::Grid& g) {
  return {{"cell_size", number(g.cell_size)},
          {"view_point", numbers(g.view_point)},
          {"ground", matrix(g.ground)},
          {"obstacle", matrix(g.obstacle)},
          {"empty", matrix(g.empty)}};
}

Json ring(const fb::Ring& points) {
  Json json = Json::array();
  for (const fb::Point* p : *points.points()) json.push_back({p->x(), p->y()});
  return json;
}

Json text(const flatbuffers::String* value) {
  return value == nullptr ? Json() : Json(value->str());
}

Json hex(const flatbuffers::Vector<std::uint8_t>* bytes) {
  return bytes == nullptr ? Json() : Json(to_hex(std::span(bytes->data(), bytes->size())));
}

Json zone(const fb::Zone& z) {
  Json json;
  json["name"] = text(z.name());
  for (const auto& [name, value] :
       {std::pair("zone_type", z.zone_type()), std::pair("label", z.label()),
        std::pair("parent", z.parent()), std::pair("layer", z.layer()),
        std::pair("floor", z.floor()), std::pair("pack", z.pack())}) {
    json[name] = text(value);
  }
  json["z"] = {number(z.z_min()), number(z.z_max())};
  json["outer"] = ring(*z.outer());
  json["holes"] = Json::array();
  if (z.holes() != nullptr) {
    for (const fb::Ring* hole : *z.holes()) json["holes"].push_back(ring(*hole));
  }
  json["signatures"] = z.signatures();
  json["features"] = z.features();
  json["pack_bytes"] = z.pack_bytes();
  json["pack_digest"] = hex(z.pack_digest());
  json["grid_needs_scan"] = z.grid_needs_scan();
  for (const fb::PayloadBytes* p : *z.payloads()) {
    json["payloads"].push_back({p->kind(), p->chunks(), p->decoded(), p->stored()});
  }
  json["slots"] = std::vector<std::uint32_t>(z.slots()->begin(), z.slots()->end());
  for (const fb::Node* n : *z.nodes()) {
    json["nodes"].push_back(
        {n->id(), number(n->x()), number(n->y()), number(n->z()), number(n->yaw())});
  }
  return json;
}

}  // namespace

Json to_json(const packer::SignatureRecord& r) {
  Json json;
  json["id"] = r.id;
  json["map_id"] = r.map_id;
  json["weight"] = r.weight;
  json["stamp"] = number(r.stamp);
  json["label"] = r.label;
  json["pose"] = transform(r.pose);
  json["odometry_pose"] = transform(r.odometry_pose);
  json["ground_truth_pose"] = transform(r.ground_truth_pose);
  json["velocity"] = hex(r.velocity);
  json["gps"] = hex(r.gps);
  json["env_sensors"] = hex(r.env_sensors);
  json["calibration"] = hex(r.calibration);
  json["features"] = features(r.features);
  json["global_descriptors"] = Json::array();
  for (const packer::GlobalDescriptor& d : r.global_descriptors) {
    json["global_descriptors"].push_back(
        {{"type", d.type}, {"info", matrix(d.info)}, {"data", matrix(d.data)}});
  }
  json["scan"] = r.scan ? scan(*r.scan) : Json();
  json["grid"] = r.grid ? grid(*r.grid) : Json();
  json["image"] = hex(r.image);
  json["depth"] = hex(r.depth);
  json["depth_confidence"] = hex(r.depth_confidence);
  json["user_data"] = matrix(r.user_data);
  json["links"] = Json::array();
  for (const packer::Link& link : r.links) {
    json["links"].push_back({{"to", link.to},
                             {"type", link.type},
                             {"transform", transform(link.transform)},
                             {"information", numbers(link.information)},
                             {"user_data", matrix(link.user_data)}});
  }
  return json;
}

Json to_json(const fb::Manifest& m) {
  Json json;
  json["lineage"] = hex(m.lineage());
  json["frame"] = text(m.frame());
  json["slot_bytes"] = m.slot_bytes();
  json["payload_mask"] = m.payload_mask();
  for (const fb::Zone* z : *m.zones()) json["zones"].push_back(zone(*z));
  for (const fb::Portal* p : *m.portals()) {
    json["portals"].push_back({{"name", text(p->name())},
                               {"zones", {p->zone_a(), p->zone_b()}},
                               {"p", {p->p()->x(), p->p()->y()}},
                               {"q", {p->q()->x(), p->q()->y()}}});
  }
  for (const fb::ZoneEdge* e : *m.edges()) {
    json["edges"].push_back({e->zone_a(), e->zone_b(), e->links()});
  }
  const fb::Provenance& p = *m.provenance();
  json["provenance"] = {{"source_kind", text(p.source_kind())},
                        {"source_version", text(p.source_version())},
                        {"packer_version", text(p.packer_version())},
                        {"lz4_version", p.lz4_version()},
                        {"options", text(p.options())},
                        {"source_feature_count", p.source_feature_count()},
                        {"source_bytes", p.source_bytes()},
                        {"detector", text(p.detector())}};
  return json;
}

}  // namespace zonepack::test_support
