// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/manifest_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

std::string_view view_of(const flatbuffers::String* text) noexcept {
  return text == nullptr ? std::string_view() : std::string_view(text->c_str(), text->size());
}

bool ring_is_sound(const fb::Ring* ring, std::uint32_t* vertices) noexcept {
  if (ring->points()->size() < 3 || !is_aligned(ring->points())) return false;
  *vertices += ring->points()->size();
  for (const fb::Point* p : *ring->points()) {
    if (!std::isfinite(p->x()) || !std::isfinite(p->y())) return false;
  }
  return *vertices <= kMaxVerticesPerZone;
}

bool file_name_is_plain(std::string_view name) noexcept {
  return !name.empty() && name.size() <= 255 && name.find('/') == name.npos && name[0] != '.' &&
         name.find('\0') == name.npos;
}

bool zone_is_sound(const fb::Manifest& manifest, const fb::Zone& zone) noexcept {
  const std::string_view name = view_of(zone.name());
  std::uint32_t vertices = 0;
  if (name.empty() || name.size() > kMaxNameBytes || !file_name_is_plain(view_of(zone.pack())) ||
      zone.pack_digest()->size() != sizeof(Digest32) || zone.signatures() > kMaxSignaturesPerZone ||
      !ring_is_sound(zone.outer(), &vertices)) {
    return false;
  }
  if (zone.holes() != nullptr) {
    for (const fb::Ring* hole : *zone.holes()) {
      if (!ring_is_sound(hole, &vertices)) return false;
    }
  }
  if (!is_aligned(zone.payloads()) || !is_aligned(zone.nodes())) return false;
  for (const fb::PayloadBytes* payload : *zone.payloads()) {
    if (payload->kind() >= 32) return false;
  }
  const auto kinds = static_cast<unsigned>(std::popcount(manifest.payload_mask() & ~kCoreOnly));
  if (kinds > 8 || zone.slots()->size() != 1u << kinds) return false;
  for (const std::uint32_t slots : *zone.slots()) {
    if (slots > kMaxChunksPerPack) return false;
  }
  if (!(zone.z_min() < zone.z_max())) return false;
  return zone.nodes() == nullptr || zone.nodes()->size() == zone.signatures();
}

}  // namespace

Result<const fb::Manifest*> check_manifest(ByteSpan file) noexcept {
  constexpr std::size_t kFrame = sizeof(ManifestHeader) + sizeof(ManifestTail);
  ManifestHeader header;
  ManifestTail tail;
  const auto size = static_cast<std::int64_t>(file.size());
  if (file.size() < kFrame) return {ErrorCode::kTruncated, size};
  std::memcpy(&header, file.data(), sizeof header);
  if (header.magic != kManifestMagic) return ErrorCode::kBadMagic;
  if (header.major != kManifestMajor) return {ErrorCode::kBadVersion, header.major};
  if (header.size > kMaxManifestBytes || header.size != file.size() - kFrame) {
    return {ErrorCode::kTruncated, size};
  }
  std::memcpy(&tail, file.data() + file.size() - sizeof tail, sizeof tail);
  if (tail.magic != kManifestEndMagic) return ErrorCode::kBadMagic;
  if (blake2b_32({file.first(file.size() - sizeof tail)}) != tail.digest) {
    return {ErrorCode::kBadChecksum, 0};
  }
  const ByteSpan body = file.subspan(sizeof header, header.size);
  flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(body.data()), body.size(), 4,
                                 kMaxZones * 8);
  if (!fb::VerifyManifestBuffer(verifier)) return ErrorCode::kBadStructure;
  const fb::Manifest& manifest = *fb::GetManifest(body.data());
  if (manifest.slot_bytes() != kSlotBytes) return {ErrorCode::kMismatch, manifest.slot_bytes()};
  if (manifest.lineage()->size() != sizeof(Digest16) || manifest.zones()->size() > kMaxZones ||
      (manifest.payload_mask() & kCoreOnly) == 0) {
    return ErrorCode::kBadValue;
  }
  std::string_view previous;
  for (const fb::Zone* zone : *manifest.zones()) {
    if (!zone_is_sound(manifest, *zone) || view_of(zone->name()) <= previous) {
      return ErrorCode::kBadValue;
    }
    previous = view_of(zone->name());
  }
  if (manifest.portals() != nullptr) {
    if (manifest.portals()->size() > kMaxPortals) return ErrorCode::kTooLarge;
    for (const fb::Portal* portal : *manifest.portals()) {
      if (!is_aligned(portal->p()) || !is_aligned(portal->q()) ||
          portal->zone_a() >= manifest.zones()->size() ||
          portal->zone_b() >= manifest.zones()->size() || portal->zone_a() == portal->zone_b() ||
          !std::isfinite(portal->p()->x()) || !std::isfinite(portal->p()->y()) ||
          !std::isfinite(portal->q()->x()) || !std::isfinite(portal->q()->y())) {
        return ErrorCode::kBadValue;
      }
    }
  }
  if (!is_aligned(manifest.edges())) return ErrorCode::kBadStructure;
  if (manifest.edges() != nullptr) {
    for (const fb::ZoneEdge* edge : *manifest.edges()) {
      if (edge->zone_a() >= edge->zone_b() || edge->zone_b() >= manifest.zones()->size()) {
        return ErrorCode::kBadValue;
      }
    }
  }
  if (manifest.signature() != nullptr && manifest.signature()->size() != kSignatureBytes) {
    return ErrorCode::kBadValue;
  }
  return &manifest;
}

Digest32 manifest_digest(ByteSpan file) noexcept {
  ManifestTail tail;
  std::memcpy(&tail, file.data() + file.size() - sizeof tail, sizeof tail);
  return tail.digest;
}

Polygon polygon_of(const fb::Zone& zone) {
  const auto ring_of = [](const fb::Ring& ring) {
    Ring points;
    points.reserve(ring.points()->size());
    for (const fb::Point* p : *ring.points()) points.push_back({p->x(), p->y()});
    return points;
  };
  Polygon polygon{ring_of(*zone.outer()), {}};
  if (zone.holes() != nullptr) {
    for (const fb::Ring* hole : *zone.holes()) polygon.holes.push_back(ring_of(*hole));
  }
  return polygon;
}

std::uint32_t slot_table_index(PayloadMask wanted, PayloadMask packed) noexcept {
  std::uint32_t index = 0;
  std::uint32_t bit = 1;
  for (PayloadMask rest = packed & ~kCoreOnly; rest != 0; rest &= rest - 1) {
    if ((wanted & rest & (~rest + 1)) != 0) index |= bit;
    bit <<= 1;
  }
  return index;
}

std::uint32_t zone_slots(const fb::Manifest& manifest, const fb::Zone& zone,
                         PayloadMask wanted) noexcept {
  const PayloadMask mask = payload_closure(wanted, zone.grid_needs_scan());
  return zone.slots()->Get(slot_table_index(mask, manifest.payload_mask()));
}

}  // namespace zonepack
