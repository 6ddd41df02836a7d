// SPDX-License-Identifier: Apache-2.0
#include "tests/support/hostile_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <vector>

#include "runtime/pack_format/bulk_chunk_generated.h"
#include "runtime/pack_format/core_chunk_generated.h"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

namespace zonepack::test_support {
namespace {

using Builder = flatbuffers::FlatBufferBuilder;
using Bytes = std::vector<std::byte>;
template <typename T>
using Vector = flatbuffers::Offset<flatbuffers::Vector<T>>;

// What the zones of a manifest say; a room of 4 m where nothing else is asked for.
struct Claims {
  std::uint32_t zones = 1;
  std::uint32_t signatures = 0;
  std::uint32_t slots = 0;
  std::uint32_t chunks = 0;
  std::uint32_t vertices = 4;  // of each outline
  std::size_t type_bytes = 0;  // of each zone_type
  std::uint32_t nodes = 0;     // of each zone, shared like everything of this length
  std::uint32_t portals = 0;   // between the first two zones
  bool share_zone = false;     // every zone is the first one
  unsigned kinds = 0;          // of payload besides the core
  bool share = false;          // one outline, one zone_type, one list of nodes, one portal
  std::size_t trailing = 0;    // zeros behind the FlatBuffer
  std::string first_name{};    // of the first zone, in place of "z000000"
  std::string frame = "map";
  std::string detector{};  // of the provenance
  PackTail pack{};         // of the first zone's pack; else there is none
  std::string pack_name = "z.zpk";
  std::uint64_t pack_bytes = 0;
};

std::string name_of(std::uint32_t zone) {
  const std::string number = std::to_string(zone);
  return "z" + std::string(6 - number.size(), '0') + number;
}

class ManifestOf {
 public:
  explicit ManifestOf(const Claims& claims) : claims_(claims) {}

  Bytes file(std::span<const std::uint8_t> lineage) {
    std::vector<flatbuffers::Offset<fb::Zone>> zones;
    for (std::uint32_t i = 0; i < claims_.zones; ++i) {
      zones.push_back(claims_.share_zone && i > 0 ? zones[0] : zone(i));
    }
    const auto zone_vector = out_.CreateVector(zones);
    std::vector<flatbuffers::Offset<fb::Portal>> portals;
    const fb::Point p(4, 1), q(4, 2);
    for (std::uint32_t i = 0; i < claims_.portals; ++i) {
      portals.push_back(claims_.share && i > 0
                            ? portals[0]
                            : fb::CreatePortal(out_, out_.CreateString("p"), 0, 1, &p, &q));
    }
    const auto portal_vector = out_.CreateVector(portals);
    const auto detector = out_.CreateString(claims_.detector);
    fb::ProvenanceBuilder from(out_);
    from.add_detector(detector);
    const auto provenance = from.Finish();
    const auto frame = out_.CreateString(claims_.frame);
    const auto line = out_.CreateVector(lineage.data(), lineage.size());
    fb::FinishManifestBuffer(
        out_, fb::CreateManifest(out_, line, frame, static_cast<std::uint32_t>(kSlotBytes),
                                 (1u << (claims_.kinds + 1)) - 1, zone_vector, portal_vector, 0,
                                 provenance));
    return sealed();
  }

 private:
  Bytes sealed() const {
    ManifestHeader header;
    const std::size_t body = out_.GetSize() + claims_.trailing;
    header.size = static_cast<std::uint32_t>(body);
    Bytes bytes(sizeof header + body + sizeof(ManifestTail));
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, out_.GetBufferPointer(), out_.GetSize());
    ManifestTail tail;
    tail.digest = blake2b_32({ByteSpan(bytes).first(sizeof header + body)});
    std::memcpy(bytes.data() + sizeof header + body, &tail, sizeof tail);
    return bytes;
  }

  flatbuffers::Offset<fb::Ring> outline() {
    if (claims_.share && !ring_.IsNull()) return ring_;
    std::vector<fb::Point> points;
    for (std::uint32_t i = 0; i < claims_.vertices; ++i) {
      const double turn = 2 * M_PI * i / claims_.vertices;
      points.emplace_back(2 + 2 * std::cos(turn), 2 + 2 * std::sin(turn));
    }
    return ring_ = fb::CreateRing(out_, out_.CreateVectorOfStructs(points));
  }

  flatbuffers::Offset<flatbuffers::String> zone_type() {
    if (claims_.share && !type_.IsNull()) return type_;
    return type_ =
               out_.CreateString(std::string(std::max<std::size_t>(claims_.type_bytes, 4), 'r'));
  }

  Vector<const fb::Node*> nodes() {
    if (claims_.share && !nodes_.IsNull()) return nodes_;
    std::vector<fb::Node> list;
    for (std::uint32_t i = 0; i < claims_.nodes; ++i) {
      list.emplace_back(1.0F, 1.0F, 0.0F, 0.0F, static_cast<std::int32_t>(i + 1));
    }
    return nodes_ = out_.CreateVectorOfStructs(list);
  }

  flatbuffers::Offset<fb::Zone> zone(std::uint32_t i) {
    const auto name =
        out_.CreateString(i == 0 && !claims_.first_name.empty() ? claims_.first_name : name_of(i));
    const auto type = zone_type();
    const auto ring = outline();
    const auto pack = out_.CreateString(i == 0 ? claims_.pack_name : "missing.zpk");
    const auto digest = out_.CreateVector(claims_.pack.digest.data(), claims_.pack.digest.size());
    std::vector<fb::PayloadBytes> listed;
    if (claims_.chunks > 0) listed.emplace_back(claims_.chunks, claims_.chunks, claims_.chunks, 0);
    const auto payloads = out_.CreateVectorOfStructs(listed);
    const std::vector<std::uint32_t> sets(std::size_t{1} << claims_.kinds, claims_.slots);
    const auto slots = out_.CreateVector(sets);
    const auto node_list = claims_.nodes > 0 ? nodes() : Vector<const fb::Node*>();
    return fb::CreateZone(out_, name, type, 0, 0, ring, 0,
                          std::max(claims_.signatures, claims_.nodes), 0, pack, claims_.pack_bytes,
                          digest, false, payloads, slots, node_list);
  }

  Claims claims_;
  Builder out_{1 << 16};
  flatbuffers::Offset<fb::Ring> ring_;
  flatbuffers::Offset<flatbuffers::String> type_;
  Vector<const fb::Node*> nodes_;
};

// A pack of zone z000000 with one chunk of one signature.
Bytes pack_of_one(const Bytes& stored, std::uint32_t decoded_size, fb::PayloadKind kind,
                  fb::ChunkCodec codec, PackTail& tail) {
  Builder out;
  const Digest16 digest = blake2b_16(stored);
  const fb::ChunkEntry entry(sizeof(PackHeader), xxh3(stored), digest,
                             static_cast<std::uint32_t>(stored.size()), decoded_size, 0, 0, 0.0F,
                             0.0F, 0.0F, 0.0F, kind, codec, 0, 0);
  const auto zone = out.CreateString("z000000");
  const auto chunks = out.CreateVectorOfStructs(&entry, 1);
  out.Finish(
      fb::CreatePackIndex(out, zone, static_cast<std::uint32_t>(kSlotBytes), 1, 0, false, chunks));
  const auto index = std::as_bytes(std::span(out.GetBufferPointer(), out.GetSize()));
  const PackHeader header;
  tail.index_offset = sizeof header + stored.size();
  tail.index_size = index.size();
  tail.digest = pack_digest(header, index, tail);
  Bytes file(sizeof header);
  std::memcpy(file.data(), &header, sizeof header);
  file.insert(file.end(), stored.begin(), stored.end());
  file.insert(file.end(), index.begin(), index.end());
  const auto end = std::as_bytes(std::span(&tail, 1));
  file.insert(file.end(), end.begin(), end.end());
  return file;
}

Bytes built(const Builder& builder) {
  const auto bytes = std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()));
  return {bytes.begin(), bytes.end()};
}

// An image of which this chunk has no row.
Bytes table_of(std::uint32_t total_rows) {
  Builder out;
  const fb::Record record(0, 0, fb::Part::Image, 0, 0, total_rows, 0, 0);
  const auto records = out.CreateVectorOfStructs(&record, 1);
  const auto columns = out.CreateVectorOfStructs(std::vector<fb::Column>());
  const auto bytes = out.CreateVector(std::vector<std::uint8_t>(kColumnPadding, 0));
  fb::FinishBulkChunkBuffer(out, fb::CreateBulkChunk(out, records, columns, bytes));
  return built(out);
}

Bytes core_with_label_of(std::size_t length) {
  Builder out;
  const fb::Transform pose(std::array<float, 12>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  const auto label = out.CreateString(std::string(length, 'l'));
  fb::SignatureBuilder signature(out);
  signature.add_id(1);
  signature.add_label(label);
  signature.add_pose(&pose);
  const auto made = signature.Finish();
  const auto list = out.CreateVector(&made, 1);
  fb::CoreChunkBuilder chunk(out);
  chunk.add_signatures(list);
  fb::FinishCoreChunkBuffer(out, chunk.Finish());
  return built(out);
}

// A pack of zone z000000 with `entries` images of a byte, and zeros behind its index.
Bytes pack_of(std::uint32_t entries, std::size_t trailing, PackTail& tail) {
  Builder out(1 << 16);
  const std::byte stored{0};
  std::vector<fb::ChunkEntry> list;
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::array<std::uint8_t, 16> digest{};
    list.emplace_back(sizeof(PackHeader) + i, xxh3({&stored, 1}), digest, 1, 1, 0, 0, 0.0F, 0.0F,
                      0.0F, 0.0F, fb::PayloadKind::Image, fb::ChunkCodec::Raw, 0, 0);
  }
  const auto zone = out.CreateString("z000000");
  const auto chunks = out.CreateVectorOfStructs(list);
  out.Finish(
      fb::CreatePackIndex(out, zone, static_cast<std::uint32_t>(kSlotBytes), 1, 0, false, chunks));
  Bytes index(out.GetSize() + trailing);
  std::memcpy(index.data(), out.GetBufferPointer(), out.GetSize());
  const PackHeader header;
  tail.index_offset = sizeof header + entries;
  tail.index_size = index.size();
  tail.digest = pack_digest(header, index, tail);
  Bytes file(tail.index_offset);
  std::memcpy(file.data(), &header, sizeof header);
  file.insert(file.end(), index.begin(), index.end());
  const auto end = std::as_bytes(std::span(&tail, 1));
  file.insert(file.end(), end.begin(), end.end());
  return file;
}

constexpr HostileKind kKinds[] = {
    {"trailing", "manifest.zpm"},      {"shared-outline", "manifest.zpm"},
    {"shared-type", "manifest.zpm"},   {"shared-nodes", "manifest.zpm"},
    {"shared-portal", "manifest.zpm"}, {"nodes", "manifest.zpm"},
    {"many-zones", "manifest.zpm"},    {"portals", "manifest.zpm"},
    {"slots", "zone z000000"},         {"most-slots", "zone z000000"},
    {"chunks", "manifest.zpm"},        {"escape", "manifest.zpm"},
    {"escape-frame", "manifest.zpm"},  {"escape-detector", "manifest.zpm"},
    {"index-trailing", "z.zpk"},       {"index-entries", "z.zpk"},
    {"other-signatures", "z.zpk"},
};

}  // namespace

std::span<const HostileKind> hostile_kinds() { return kKinds; }

MemoryFolder hostile_map(const std::string& kind, std::span<const std::uint8_t> lineage) {
  Claims claims;
  MemoryFolder map;
  const auto with_pack = [&](std::uint32_t entries, std::size_t trailing) {
    map.files[claims.pack_name] = pack_of(entries, trailing, claims.pack);
    claims.pack_bytes = map.files[claims.pack_name].size();
    claims.signatures = 1;
  };
  if (kind == "trailing") claims.trailing = 64 * kMiB;
  if (kind == "shared-outline") claims = {.zones = 20'000, .vertices = 4096, .share = true};
  if (kind == "shared-type") claims = {.zones = 5000, .type_bytes = 60'000, .share = true};
  if (kind == "shared-nodes") claims = {.zones = 2000, .nodes = 20'000, .share = true};
  if (kind == "shared-portal") claims = {.zones = 2, .portals = 120'000, .share = true};
  if (kind == "nodes") claims = {.nodes = 1'500'000};
  if (kind == "many-zones") claims = {.zones = 150'000, .share = true};
  if (kind == "portals") claims = {.zones = 2, .portals = 5000};
  if (kind == "slots") claims.slots = 65'536;
  if (kind == "most-slots") claims.slots = kMaxChunksPerPack;
  if (kind == "chunks") claims.chunks = kMaxChunksPerPack;
  if (kind == "escape") claims.first_name = "a\x1b[2Jb";
  if (kind == "escape-frame") claims.frame = "map\x1b[2J";
  if (kind == "escape-detector")
    claims.detector =
        "6\xC2\x9B"
        "2J";  // U+009B
  if (kind == "index-trailing") with_pack(0, 64 * kMiB);
  if (kind == "index-entries") with_pack(1'000'000, 0);
  if (kind == "other-signatures") {
    with_pack(0, 0);
    claims.signatures = 7;
  }
  if (std::ranges::none_of(kKinds, [&](const HostileKind& known) { return kind == known.name; })) {
    throw std::runtime_error("no hostile map is called " + kind);
  }
  map.files[std::string(kManifestName)] = ManifestOf(claims).file(lineage);
  return map;
}

MemoryFolder map_that_measures(LimitId id, std::uint64_t found) {
  Claims claims;
  MemoryFolder map;
  const auto count = static_cast<std::uint32_t>(found);
  const auto with_chunk = [&](const Bytes& stored, std::uint32_t decoded, fb::PayloadKind kind,
                              fb::ChunkCodec codec = fb::ChunkCodec::Raw) {
    map.files[claims.pack_name] = pack_of_one(stored, decoded, kind, codec, claims.pack);
    claims.pack_bytes = map.files[claims.pack_name].size();
    claims.signatures = 1;
    claims.slots = 1;
    claims.chunks = 1;
  };
  const auto with_raw = [&](const Bytes& chunk, fb::PayloadKind kind) {
    with_chunk(chunk, static_cast<std::uint32_t>(chunk.size()), kind);
  };
  constexpr auto kSlot = static_cast<std::uint32_t>(kSlotBytes);
  switch (id) {
    case LimitId::kDecodedBytes:
      with_chunk(Bytes(1), count, fb::PayloadKind::Core, fb::ChunkCodec::Lz4);
      break;
    case LimitId::kStoredBytes:
      with_chunk(Bytes(count), kSlot, fb::PayloadKind::Core, fb::ChunkCodec::Lz4);
      break;
    case LimitId::kRowsOfTable:
      claims.kinds = 4;  // with images
      with_raw(table_of(count), fb::PayloadKind::Image);
      break;
    case LimitId::kCoreBlobBytes:
      with_raw(core_with_label_of(count), fb::PayloadKind::Core);
      break;
    case LimitId::kChunksOfPack:
      claims.chunks = count;
      break;
    case LimitId::kSlotsOfZone:
      claims.slots = count;
      break;
    case LimitId::kSignaturesOfZone:
      claims.signatures = count;
      break;
    case LimitId::kZones:
      claims.zones = count;
      claims.share_zone = true;
      break;
    case LimitId::kPortals:
      claims.zones = 2;
      claims.portals = count;
      claims.share = true;
      break;
    case LimitId::kPortalsOfZone:
      claims.zones = 2;
      claims.portals = count;
      break;
    case LimitId::kVerticesOfZone:
      claims.vertices = count;
      break;
    case LimitId::kNameBytes:
      claims.first_name = std::string(count, 'n');
      break;
    case LimitId::kPackNameBytes:
      claims.pack_name = std::string(count, 'p');
      break;
    case LimitId::kPayloadKinds:
      claims.kinds = count;
      break;
    case LimitId::kChunksOfSlot:
    case LimitId::kIndexBytes:
    case LimitId::kManifestBytes:
      throw std::runtime_error(std::string("no map measures ") + limit(id).name);
  }
  constexpr Digest16 kLineage = {1, 2, 3};
  map.files[std::string(kManifestName)] = ManifestOf(claims).file(kLineage);
  return map;
}

}  // namespace zonepack::test_support
