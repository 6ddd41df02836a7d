// SPDX-License-Identifier: Apache-2.0
#include "packer/build/manifest_writer.hpp"

#include <lz4.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "packer/encode/format_limit.hpp"
#include "platform/base/require.hpp"
#include "platform/version/version.hpp"
#include "runtime/pack_format/file/zone_name.hpp"

namespace zonepack::packer {
namespace {

void check_limits(const ZonePlan& plan, const std::vector<PackSummary>& packs) {
  require_within(LimitId::kZones, plan.zones.size());
  require_within(LimitId::kPortals, plan.portals.size());
  const std::vector<std::size_t> portals = portals_per_zone(plan);
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    const PlannedZone& zone = plan.zones[i];
    const std::string what = "zone " + zone.name;
    std::uint64_t vertices = zone.polygon.outer.size();
    for (const Ring& hole : zone.polygon.holes) vertices += hole.size();
    std::uint64_t chunks = 0;
    for (const PackSummary::Payload& payload : packs[i].payloads) chunks += payload.chunks;
    require_within(LimitId::kNameBytes, zone.name.size(), what);
    require_within(LimitId::kVerticesOfZone, vertices, what);
    require_within(LimitId::kPortalsOfZone, portals[i], what);
    require_within(LimitId::kSignaturesOfZone, packs[i].signatures, what);
    require_within(LimitId::kChunksOfPack, chunks, what);
  }
}

// A text of the source that is not fit to be printed is as good as none.
std::string plain_or_nothing(const std::string& text) { return is_plain_text(text) ? text : ""; }

using Builder = flatbuffers::FlatBufferBuilder;

flatbuffers::Offset<flatbuffers::String> text(Builder& builder, const std::string& value) {
  return value.empty() ? 0 : builder.CreateString(value);
}

flatbuffers::Offset<fb::Ring> ring(Builder& builder, const Ring& points) {
  std::vector<fb::Point> out;
  out.reserve(points.size());
  for (const Point2& p : points) out.emplace_back(p.x_m, p.y_m);
  return fb::CreateRing(builder, builder.CreateVectorOfStructs(out));
}

template <std::size_t N>
flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>> digest(
    Builder& builder, const std::array<std::uint8_t, N>& bytes) {
  return builder.CreateVector(bytes.data(), bytes.size());
}

flatbuffers::Offset<fb::Zone> zone_table(Builder& builder, const PlannedZone& zone,
                                         const PackSummary& pack,
                                         const std::vector<fb::Node>& nodes) {
  std::vector<flatbuffers::Offset<fb::Ring>> holes;
  for (const Ring& hole : zone.polygon.holes) holes.push_back(ring(builder, hole));
  std::vector<fb::PayloadBytes> payloads;
  for (std::size_t k = 0; k < pack.payloads.size(); ++k) {
    const PackSummary::Payload& payload = pack.payloads[k];
    if (payload.chunks == 0) continue;
    payloads.emplace_back(payload.decoded, payload.stored, payload.chunks,
                          static_cast<std::uint8_t>(k));
  }
  const auto name = builder.CreateString(zone.name);
  const auto zone_type = text(builder, zone.zone_type);
  const auto label = text(builder, zone.label);
  const auto parent = text(builder, zone.parent);
  const auto outer = ring(builder, zone.polygon.outer);
  const auto hole_vector = holes.empty() ? 0 : builder.CreateVector(holes);
  const auto file = builder.CreateString(pack.file);
  const auto pack_digest = digest(builder, pack.digest);
  const auto payload_vector = builder.CreateVectorOfStructs(payloads);
  const auto slots = builder.CreateVector(pack.slots);
  const auto node_vector = builder.CreateVectorOfStructs(nodes);
  const auto layer = text(builder, zone.layer);
  const auto floor = text(builder, zone.floor);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return fb::CreateZone(builder, name, zone_type, label, parent, outer, hole_vector,
                        pack.signatures, pack.features, file, pack.bytes, pack_digest,
                        pack.grid_needs_scan, payload_vector, slots, node_vector, layer, floor,
                        zone.z_min_m.value_or(-kInfinity), zone.z_max_m.value_or(kInfinity));
}

using Names = flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>>;

Names names(Builder& builder, const std::vector<std::string>& list) {
  return list.empty() ? 0 : builder.CreateVectorOfStrings(list);
}

flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<fb::Layer>>> layers(
    Builder& builder, const std::vector<NamedLayer>& list) {
  if (list.empty()) return 0;
  std::vector<flatbuffers::Offset<fb::Layer>> tables;
  for (const NamedLayer& layer : list) {
    std::vector<fb::SessionRange> sessions;
    for (const auto& [first, last] : layer.sessions) sessions.emplace_back(first, last);
    const auto name = builder.CreateString(layer.name);
    tables.push_back(fb::CreateLayer(builder, name, builder.CreateVectorOfStructs(sessions)));
  }
  return builder.CreateVector(tables);
}

flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<fb::Change>>> changes(
    Builder& builder, const std::vector<VersionChange>& list) {
  if (list.empty()) return 0;
  std::vector<flatbuffers::Offset<fb::Change>> tables;
  for (const VersionChange& change : list) {
    const auto parent = digest(builder, change.parent);
    const auto what = builder.CreateString(change.what);
    const Names added = names(builder, change.added);
    const Names removed = names(builder, change.removed);
    const Names changed = names(builder, change.changed);
    const Names drawn = names(builder, change.drawn);
    const Names replaced = names(builder, change.replaced);
    tables.push_back(fb::CreateChange(builder, parent, what, change.zones, change.signatures,
                                      change.pack_bytes, added, removed, changed, drawn, replaced));
  }
  return builder.CreateVector(tables);
}

}  // namespace

fb::Node node_at(std::int32_t id, const Transform& T_map_base) {
  // Yaw is for people and pictures. The pose is a row-major 3x4 matrix: [0] is cos, [4] is sin.
  const float yaw = std::atan2(T_map_base[4], T_map_base[0]);
  return {T_map_base[3], T_map_base[7], T_map_base[11], yaw, id};
}

Bytes manifest_bytes(const ManifestContent& content) {
  const ZonePlan& plan = *content.plan;
  check_limits(plan, *content.packs);
  Builder builder(1 << 16);
  std::vector<flatbuffers::Offset<fb::Zone>> zones;
  for (std::size_t i = 0; i < plan.zones.size(); ++i) {
    zones.push_back(zone_table(builder, plan.zones[i], (*content.packs)[i], content.nodes[i]));
  }
  std::vector<flatbuffers::Offset<fb::Portal>> portals;
  for (const PlannedPortal& portal : plan.portals) {
    const fb::Point p(portal.segment.p.x_m, portal.segment.p.y_m);
    const fb::Point q(portal.segment.q.x_m, portal.segment.q.y_m);
    portals.push_back(fb::CreatePortal(builder, text(builder, portal.name), portal.zone_a,
                                       portal.zone_b, &p, &q));
  }
  const auto provenance = fb::CreateProvenance(
      builder, text(builder, content.source_kind),
      text(builder, plain_or_nothing(content.source_version)), builder.CreateString(version()),
      static_cast<std::uint32_t>(LZ4_versionNumber()), text(builder, content.options),
      content.source_feature_count, content.source_bytes,
      text(builder, plain_or_nothing(content.detector)));
  const auto lineage = digest(builder, content.lineage);
  const auto frame = builder.CreateString("map");
  const auto zone_vector = builder.CreateVector(zones);
  const auto portal_vector = builder.CreateVector(portals);
  const auto edges = builder.CreateVectorOfStructs(content.edges);
  const auto layer_vector = layers(builder, content.layers);
  const auto change_vector = changes(builder, content.changes);
  fb::FinishManifestBuffer(
      builder, fb::CreateManifest(builder, lineage, frame, static_cast<std::uint32_t>(kSlotBytes),
                                  content.payload, zone_vector, portal_vector, edges, provenance, 0,
                                  layer_vector, change_vector));
  require_within(LimitId::kManifestBytes, builder.GetSize());
  ManifestHeader header;
  header.size = builder.GetSize();
  constexpr auto blocks = static_cast<std::size_t>(fb::PayloadKind::Blocks);
  const bool any_blocks = std::ranges::any_of(
      *content.packs, [](const PackSummary& pack) { return pack.payloads[blocks].chunks > 0; });
  if (!content.layers.empty() || !content.changes.empty() || any_blocks) {
    header.minor = kManifestMinorOfLayers;
  }
  Bytes file(sizeof header + header.size + sizeof(ManifestTail));
  std::memcpy(file.data(), &header, sizeof header);
  std::memcpy(file.data() + sizeof header, builder.GetBufferPointer(), header.size);
  ManifestTail tail;
  tail.digest = blake2b_32({ByteSpan(file).first(sizeof header + header.size)});
  std::memcpy(file.data() + file.size() - sizeof tail, &tail, sizeof tail);
  ZP_REQUIRE(check_manifest(file).ok());
  return file;
}

}  // namespace zonepack::packer
