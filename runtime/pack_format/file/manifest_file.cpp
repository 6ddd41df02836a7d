// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/manifest_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "runtime/pack_format/file/pack_file.hpp"
#include "runtime/pack_format/file/zone_name.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

std::string_view view_of(const flatbuffers::String* text) noexcept {
  return text == nullptr ? std::string_view() : std::string_view(text->c_str(), text->size());
}

// What the zones and portals of a manifest refer to, each piece as often as it is referred to. A
// FlatBuffer may share a piece between tables, so that a short file describes a large map; a packer
// never does, and readers copy.
class Contents {
 public:
  explicit Contents(ByteCount file_bytes) : left_(file_bytes) {}

  // False when the pieces are more than the file has bytes.
  template <typename T>
  bool add(const flatbuffers::Vector<T>* piece, ByteCount item_bytes) noexcept {
    const ByteCount bytes =
        piece == nullptr ? 0 : sizeof(std::uint32_t) + piece->size() * item_bytes;
    if (bytes > left_) return false;
    left_ -= bytes;
    return true;
  }
  bool add(const flatbuffers::String* text) noexcept { return add<char>(text, 1); }

 private:
  ByteCount left_;
};

bool ring_is_sound(const fb::Ring* ring, std::uint32_t* vertices, Contents& contents) noexcept {
  if (ring->points()->size() < 3 || !is_aligned(ring->points())) return false;
  if (ring->points()->size() > kMaxVerticesPerZone - *vertices) return false;
  if (!contents.add(ring->points(), sizeof(fb::Point))) return false;
  *vertices += ring->points()->size();
  for (const fb::Point* p : *ring->points()) {
    if (!std::isfinite(p->x()) || !std::isfinite(p->y())) return false;
  }
  return true;
}

bool text_is_plain(const flatbuffers::String* text, Contents& contents) noexcept {
  return text == nullptr || (contents.add(text) && is_plain_text(view_of(text)));
}

bool file_name_is_plain(std::string_view name) noexcept {
  return !name.empty() && name.size() <= 255 && name.find('/') == name.npos && name[0] != '.' &&
         name.find('\0') == name.npos;
}

bool texts_are_sound(const fb::Zone& zone, Contents& contents) noexcept {
  for (const flatbuffers::String* const text :
       {zone.name(), zone.zone_type(), zone.label(), zone.parent(), zone.pack(), zone.layer(),
        zone.floor()}) {
    if (!text_is_plain(text, contents)) return false;
  }
  return !name_fault(view_of(zone.name())) && file_name_is_plain(view_of(zone.pack()));
}

bool zone_is_sound(const fb::Manifest& manifest, const fb::Zone& zone,
                   Contents& contents) noexcept {
  std::uint32_t vertices = 0;
  if (!texts_are_sound(zone, contents) || zone.pack_digest()->size() != sizeof(Digest32) ||
      zone.signatures() > kMaxSignaturesPerZone ||
      !ring_is_sound(zone.outer(), &vertices, contents)) {
    return false;
  }
  if (zone.holes() != nullptr) {
    if (!contents.add(zone.holes(), sizeof(std::uint32_t))) return false;
    for (const fb::Ring* hole : *zone.holes()) {
      if (!ring_is_sound(hole, &vertices, contents)) return false;
    }
  }
  if (!is_aligned(zone.payloads()) || !is_aligned(zone.nodes())) return false;
  if (!contents.add(zone.pack_digest(), 1) || !contents.add(zone.slots(), sizeof(std::uint32_t)) ||
      !contents.add(zone.payloads(), sizeof(fb::PayloadBytes)) ||
      !contents.add(zone.nodes(), sizeof(fb::Node)) || zone.payloads()->size() > 32) {
    return false;
  }
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

// Of portals between known zones: no zone has more than a control cycle has time for.
bool portals_are_few(const fb::Manifest& manifest) {
  std::vector<std::uint16_t> counts(manifest.zones()->size(), 0);
  for (const fb::Portal* portal : *manifest.portals()) {
    for (const ZoneId zone : {portal->zone_a(), portal->zone_b()}) {
      if (++counts[zone] > kMaxPortalsPerZone) return false;
    }
  }
  return true;
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
  Contents contents(body.size());
  std::string_view previous;
  for (const fb::Zone* zone : *manifest.zones()) {
    if (!zone_is_sound(manifest, *zone, contents) || view_of(zone->name()) <= previous) {
      return ErrorCode::kBadValue;
    }
    previous = view_of(zone->name());
  }
  if (manifest.portals() != nullptr) {
    if (manifest.portals()->size() > kMaxPortals) return ErrorCode::kTooLarge;
    for (const fb::Portal* portal : *manifest.portals()) {
      if (!text_is_plain(portal->name(), contents) || !is_aligned(portal->p()) ||
          !is_aligned(portal->q()) || portal->zone_a() >= manifest.zones()->size() ||
          portal->zone_b() >= manifest.zones()->size() || portal->zone_a() == portal->zone_b() ||
          !std::isfinite(portal->p()->x()) || !std::isfinite(portal->p()->y()) ||
          !std::isfinite(portal->q()->x()) || !std::isfinite(portal->q()->y())) {
        return ErrorCode::kBadValue;
      }
    }
  }
  if (manifest.portals() != nullptr && !portals_are_few(manifest)) return ErrorCode::kTooLarge;
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
