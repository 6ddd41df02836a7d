// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <vector>

#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/file/zone_name.hpp"
#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack {
namespace {

using Part = ManifestFault::Part;

std::string_view view_of(const flatbuffers::String* text) noexcept {
  return text == nullptr ? std::string_view() : std::string_view(text->c_str(), text->size());
}

template <typename T>
ByteCount bytes_of(const flatbuffers::Vector<T>* piece, ByteCount item_bytes) noexcept {
  return piece == nullptr ? 0 : sizeof(std::uint32_t) + piece->size() * item_bytes;
}

bool is_finite(const fb::Point& p) noexcept { return std::isfinite(p.x()) && std::isfinite(p.y()); }

bool file_name_is_plain(std::string_view name) noexcept {
  return !name.empty() && name.find('/') == name.npos && name[0] != '.';
}

// Checks the FlatBuffer of a manifest that FlatBuffers' verifier has accepted.
//
// Zones and portals may refer to no more, each piece as often as it is referred to, than the file
// has bytes: a FlatBuffer may share a piece between tables, so that a short file describes a large
// map; a packer never does, and readers copy. And a file has no more bytes than are referred to,
// but for its tables: readers would hold them.
class ManifestCheck {
 public:
  ManifestCheck(const fb::Manifest& manifest, ByteCount body_bytes, std::uint16_t minor,
                ManifestFault& fault) noexcept
      : manifest_(manifest), body_bytes_(body_bytes), minor_(minor), fault_(fault) {}

  Result<void> run() {
    if (const auto whole = root(); !whole) return whole;
    std::string_view previous;
    for (std::uint32_t i = 0; i < manifest_.zones()->size(); ++i) {
      const fb::Zone& zone = *manifest_.zones()->Get(i);
      const std::string_view name = view_of(zone.name());
      enter(Part::kZone, i, name_fault(name) ? std::string_view() : name);
      if (const auto sound = check(zone); !sound) return sound;
      if (name <= previous) return refuse("name", "is not sorted behind the one before");
      previous = name;
    }
    if (const auto sound = portals(); !sound) return sound;
    if (const auto sound = edges(); !sound) return sound;
    enter(Part::kWhole, 0, {});
    if (manifest_.signature() != nullptr && manifest_.signature()->size() != kSignatureBytes) {
      return refuse("signature", "is not of 64 bytes");
    }
    if (const auto sound = layers(); !sound) return sound;
    if (const auto sound = changes(); !sound) return sound;
    return nothing_else();
  }

 private:
  // What tables, padding and offsets take at most, generously.
  static constexpr ByteCount kRootTables = 4096;
  static constexpr ByteCount kZoneTables = 512;
  static constexpr ByteCount kHoleTables = 64;
  static constexpr ByteCount kPortalTables = 128;
  static constexpr ByteCount kLayerTables = 64;
  static constexpr ByteCount kChangeTables = 128;
  static constexpr ByteCount kNameOffset = 8;  // of a text in a list, and its padding

  void enter(Part part, std::uint32_t entry, std::string_view name) noexcept {
    fault_.part = part;
    fault_.entry = entry;
    fault_.name = name;
  }
  Error refuse(const char* field, const char* expected,
               ErrorCode code = ErrorCode::kBadValue) noexcept {
    fault_.field = field;
    fault_.expected = expected;
    return {code};
  }
  Error over(LimitId id, std::uint64_t found, ErrorCode code = ErrorCode::kBadValue) noexcept {
    fault_.excess = Excess{id, found};
    return {code};
  }

  // False when zones and portals refer to more than the file has bytes.
  bool holds(ByteCount bytes) noexcept {
    if (bytes > body_bytes_ - held_) return false;
    held_ += bytes;
    return true;
  }
  Error shared(const char* field) noexcept {
    return refuse(field,
                  "is referred to more than once, so that readers would copy more than the "
                  "file has");
  }

  Result<void> text(const char* field, const flatbuffers::String* value) noexcept {
    if (value == nullptr) return {};
    if (!holds(bytes_of<char>(value, 1))) return shared(field);
    if (is_plain_text(view_of(value))) return {};
    return refuse(field, "is not UTF-8 without control characters");
  }

  Result<void> root() noexcept {
    if (manifest_.lineage()->size() != sizeof(Digest16)) {
      return refuse("lineage", "is not of 16 bytes");
    }
    if ((manifest_.payload_mask() & kCoreOnly) == 0) {
      return refuse("payload_mask", "leaves out the core");
    }
    if (is_over(LimitId::kZones, manifest_.zones()->size())) {
      return over(LimitId::kZones, manifest_.zones()->size());
    }
    const auto kinds = static_cast<unsigned>(std::popcount(manifest_.payload_mask() & ~kCoreOnly));
    if (is_over(LimitId::kPayloadKinds, kinds)) return over(LimitId::kPayloadKinds, kinds);
    kinds_ = kinds;
    const fb::Provenance& from = *manifest_.provenance();
    const std::pair<const char*, const flatbuffers::String*> texts[] = {
        {"frame", manifest_.frame()},
        {"provenance.source_kind", from.source_kind()},
        {"provenance.source_version", from.source_version()},
        {"provenance.packer_version", from.packer_version()},
        {"provenance.options", from.options()},
        {"provenance.detector", from.detector()}};
    for (const auto& [field, value] : texts) {
      if (const auto plain = text(field, value); !plain) return plain;
    }
    return {};
  }

  Result<void> ring(const char* field, const fb::Ring& ring, std::uint64_t& vertices) noexcept {
    const auto& points = *ring.points();
    if (points.size() < 3) return refuse(field, "has fewer than 3 points");
    if (!is_aligned(&points)) return refuse(field, "is not aligned");
    vertices += points.size();
    if (is_over(LimitId::kVerticesOfZone, vertices)) {
      return over(LimitId::kVerticesOfZone, vertices);
    }
    if (!holds(bytes_of(&points, sizeof(fb::Point)))) return shared(field);
    for (const fb::Point* p : points) {
      if (!is_finite(*p)) return refuse(field, "has a coordinate that is not finite");
    }
    return {};
  }

  Result<void> check(const fb::Zone& zone) noexcept {
    if (const auto sound = texts_of(zone); !sound) return sound;
    if (const auto sound = outline_of(zone); !sound) return sound;
    if (const auto sound = pieces_of(zone); !sound) return sound;
    return contents_of(zone);
  }

  Result<void> texts_of(const fb::Zone& zone) noexcept {
    const std::pair<const char*, const flatbuffers::String*> texts[] = {
        {"name", zone.name()},     {"zone_type", zone.zone_type()}, {"label", zone.label()},
        {"parent", zone.parent()}, {"pack", zone.pack()},           {"layer", zone.layer()},
        {"floor", zone.floor()}};
    for (const auto& [field, value] : texts) {
      if (const auto plain = text(field, value); !plain) return plain;
    }
    const std::string_view name = view_of(zone.name());
    if (is_over(LimitId::kNameBytes, name.size())) return over(LimitId::kNameBytes, name.size());
    if (name_fault(name)) return refuse("name", "is not what a zone may be called (FORMAT.md)");
    const std::string_view pack = view_of(zone.pack());
    if (is_over(LimitId::kPackNameBytes, pack.size())) {
      return over(LimitId::kPackNameBytes, pack.size());
    }
    if (!file_name_is_plain(pack)) return refuse("pack", "is not the name of a file in the folder");
    return {};
  }

  Result<void> outline_of(const fb::Zone& zone) noexcept {
    std::uint64_t vertices = 0;
    if (const auto sound = ring("outer", *zone.outer(), vertices); !sound) return sound;
    if (zone.holes() != nullptr) {
      if (!holds(bytes_of(zone.holes(), sizeof(std::uint32_t)))) return shared("holes");
      tables_ += zone.holes()->size() * kHoleTables;
      for (const fb::Ring* hole : *zone.holes()) {
        if (const auto sound = ring("holes", *hole, vertices); !sound) return sound;
      }
    }
    if (!(zone.z_min() < zone.z_max())) return refuse("z_min", "is not below z_max");
    return {};
  }

  Result<void> pieces_of(const fb::Zone& zone) noexcept {
    if (zone.pack_digest()->size() != sizeof(Digest32)) {
      return refuse("pack_digest", "is not of 32 bytes");
    }
    if (!is_aligned(zone.payloads())) return refuse("payloads", "is not aligned");
    if (!is_aligned(zone.nodes())) return refuse("nodes", "is not aligned");
    if (!holds(bytes_of(zone.pack_digest(), 1))) return shared("pack_digest");
    if (!holds(bytes_of(zone.slots(), sizeof(std::uint32_t)))) return shared("slots");
    if (!holds(bytes_of(zone.payloads(), sizeof(fb::PayloadBytes)))) return shared("payloads");
    if (!holds(bytes_of(zone.nodes(), sizeof(fb::Node)))) return shared("nodes");
    return {};
  }

  Result<void> contents_of(const fb::Zone& zone) noexcept {
    if (is_over(LimitId::kSignaturesOfZone, zone.signatures())) {
      return over(LimitId::kSignaturesOfZone, zone.signatures());
    }
    if (zone.nodes() != nullptr && zone.nodes()->size() != zone.signatures()) {
      return refuse("nodes", "is not as long as the zone has signatures");
    }
    constexpr std::uint32_t kKinds = 32;  // that a mask can name
    if (zone.payloads()->size() > kKinds) return refuse("payloads", "lists more than 32 kinds");
    std::uint64_t chunks = 0;
    for (const fb::PayloadBytes* payload : *zone.payloads()) {
      if (payload->kind() >= kKinds) return refuse("payloads", "has a kind over 31");
      chunks += payload->chunks();
    }
    if (is_over(LimitId::kChunksOfPack, chunks)) return over(LimitId::kChunksOfPack, chunks);
    if (zone.slots()->size() != 1u << kinds_) {
      return refuse("slots", "has not one entry for each set of payload kinds");
    }
    for (const std::uint32_t slots : *zone.slots()) {
      if (is_over(LimitId::kSlotsOfZone, slots)) return over(LimitId::kSlotsOfZone, slots);
    }
    return {};
  }

  Result<void> portals() {
    if (manifest_.portals() == nullptr) return {};
    const auto& portals = *manifest_.portals();
    enter(Part::kWhole, 0, {});
    if (is_over(LimitId::kPortals, portals.size())) {
      return over(LimitId::kPortals, portals.size(), ErrorCode::kTooLarge);
    }
    const std::uint32_t zones = manifest_.zones()->size();
    for (std::uint32_t i = 0; i < portals.size(); ++i) {
      const fb::Portal& portal = *portals.Get(i);
      enter(Part::kPortal, i, {});
      if (const auto plain = text("name", portal.name()); !plain) return plain;
      enter(Part::kPortal, i, view_of(portal.name()));
      if (!is_aligned(portal.p()) || !is_aligned(portal.q())) {
        return refuse("p", "is not aligned");
      }
      if (portal.zone_a() >= zones || portal.zone_b() >= zones ||
          portal.zone_a() == portal.zone_b()) {
        return refuse("zone_a", "and zone_b are not two zones of the map");
      }
      if (!is_finite(*portal.p()) || !is_finite(*portal.q())) {
        return refuse("p", "or q is not finite");
      }
    }
    return portals_of_zones();
  }

  // Of portals between known zones: no zone has more than a control cycle has time for.
  Result<void> portals_of_zones() {
    std::vector<std::uint32_t> counts(manifest_.zones()->size(), 0);
    for (const fb::Portal* portal : *manifest_.portals()) {
      ++counts[portal->zone_a()];
      ++counts[portal->zone_b()];
    }
    for (std::uint32_t i = 0; i < counts.size(); ++i) {
      if (!is_over(LimitId::kPortalsOfZone, counts[i])) continue;
      enter(Part::kZone, i, view_of(manifest_.zones()->Get(i)->name()));
      return over(LimitId::kPortalsOfZone, counts[i], ErrorCode::kTooLarge);
    }
    return {};
  }

  Result<void> edges() noexcept {
    if (manifest_.edges() == nullptr) return {};
    enter(Part::kWhole, 0, {});
    if (!is_aligned(manifest_.edges())) {
      return refuse("edges", "is not aligned", ErrorCode::kBadStructure);
    }
    for (std::uint32_t i = 0; i < manifest_.edges()->size(); ++i) {
      const fb::ZoneEdge& edge = *manifest_.edges()->Get(i);
      if (edge.zone_a() < edge.zone_b() && edge.zone_b() < manifest_.zones()->size()) continue;
      enter(Part::kEdge, i, {});
      return refuse("zone_a", "is not below zone_b, or zone_b is no zone of the map");
    }
    return {};
  }

  Result<void> layers() noexcept {
    if (manifest_.layers() == nullptr) return {};
    if (minor_ < kManifestMinorOfLayers) return refuse("layers", "are not of minor version 0");
    const auto& layers = *manifest_.layers();
    if (layers.size() > kMaxLayers) return refuse("layers", "are more than 64");
    if (!holds(bytes_of(&layers, sizeof(std::uint32_t)))) return shared("layers");
    std::string_view previous;
    for (const fb::Layer* layer : layers) {
      if (const auto plain = text("layers", layer->name()); !plain) return plain;
      const std::string_view name = view_of(layer->name());
      if (name_fault(name)) return refuse("layers", "has a name that is not fit for one");
      if (name <= previous) return refuse("layers", "are not sorted by name");
      previous = name;
      const auto& sessions = *layer->sessions();
      if (!is_aligned(&sessions)) return refuse("layers", "is not aligned");
      if (sessions.size() > kMaxSessionRanges) {
        return refuse("layers", "has a layer of more than 4096 ranges of sessions");
      }
      if (!holds(bytes_of(&sessions, sizeof(fb::SessionRange)))) return shared("layers");
      const fb::SessionRange* before = nullptr;
      for (const fb::SessionRange* range : sessions) {
        if (range->first() > range->last() ||
            (before != nullptr && range->first() <= before->last())) {
          return refuse("layers", "has sessions that are not ascending");
        }
        before = range;
      }
      tables_ += kLayerTables;
    }
    return {};
  }

  Result<void> names(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* list) {
    if (list == nullptr) return {};
    if (!holds(bytes_of(list, sizeof(std::uint32_t)))) return shared("changes");
    for (const flatbuffers::String* name : *list) {
      if (const auto plain = text("changes", name); !plain) return plain;
      if (name_fault(view_of(name))) return refuse("changes", "names what is no zone's name");
      tables_ += kNameOffset;
    }
    return {};
  }

  Result<void> changes() noexcept {
    if (manifest_.changes() == nullptr) return {};
    if (minor_ < kManifestMinorOfLayers) return refuse("changes", "are not of minor version 0");
    const auto& changes = *manifest_.changes();
    if (changes.size() > kMaxChanges) return refuse("changes", "are more than 1024");
    if (!holds(bytes_of(&changes, sizeof(std::uint32_t)))) return shared("changes");
    for (const fb::Change* change : changes) {
      if (change->parent()->size() != sizeof(Digest32)) {
        return refuse("changes", "has a parent that is not of 32 bytes");
      }
      if (!holds(bytes_of(change->parent(), 1))) return shared("changes");
      if (const auto plain = text("changes", change->what()); !plain) return plain;
      for (const auto* list : {change->added(), change->removed(), change->changed(),
                               change->drawn(), change->replaced()}) {
        if (const auto plain = names(list); !plain) return plain;
      }
      tables_ += kChangeTables;
    }
    return {};
  }

  // A minor version that is not known may hold more.
  Result<void> nothing_else() noexcept {
    const ByteCount portals = manifest_.portals() == nullptr ? 0 : manifest_.portals()->size();
    const ByteCount most = held_ + tables_ + kRootTables + manifest_.zones()->size() * kZoneTables +
                           portals * kPortalTables +
                           bytes_of(manifest_.edges(), sizeof(fb::ZoneEdge));
    if (minor_ > kManifestMinor || body_bytes_ <= most) return {};
    return refuse("",
                  "the file has more bytes than its zones, portals and texts take: others "
                  "stand behind or between them",
                  ErrorCode::kBadStructure);
  }

  const fb::Manifest& manifest_;
  ByteCount body_bytes_;
  std::uint16_t minor_;
  ManifestFault& fault_;
  ByteCount held_ = 0;    // bytes of the pieces referred to so far
  ByteCount tables_ = 0;  // of holes, layers and changes
  unsigned kinds_ = 0;    // of payload, besides the core
};

}  // namespace

Result<const fb::Manifest*> check_manifest(ByteSpan file, ManifestFault* fault) noexcept {
  ManifestFault ignored;
  ManifestFault& found = fault == nullptr ? ignored : *fault;
  found = {};
  constexpr std::size_t kFrame = sizeof(ManifestHeader) + sizeof(ManifestTail);
  ManifestHeader header;
  ManifestTail tail;
  const auto size = static_cast<std::int64_t>(file.size());
  if (file.size() < kFrame) return {ErrorCode::kTruncated, size};
  std::memcpy(&header, file.data(), sizeof header);
  if (header.magic != kManifestMagic) return ErrorCode::kBadMagic;
  if (header.major != kManifestMajor) return {ErrorCode::kBadVersion, header.major};
  if (is_over(LimitId::kManifestBytes, header.size)) {
    found.excess = Excess{LimitId::kManifestBytes, header.size};
    return {ErrorCode::kTruncated, size};
  }
  if (header.size != file.size() - kFrame) return {ErrorCode::kTruncated, size};
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
  ManifestCheck check(manifest, body.size(), header.minor, found);
  if (const auto sound = check.run(); !sound) return sound.error();
  return &manifest;
}

}  // namespace zonepack
