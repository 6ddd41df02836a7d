// SPDX-License-Identifier: Apache-2.0
#include "packer/inspect/pack_inspection.hpp"

#include <array>
#include <stdexcept>
#include <vector>

#include "packer/console/text_table.hpp"
#include "packer/console/words.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/verify/problem.hpp"
#include "platform/base/failure.hpp"
#include "platform/base/shell_word.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack::packer {
namespace {

using Json = nlohmann::ordered_json;

const char* codec_text(fb::ChunkCodec codec) {
  return codec == fb::ChunkCodec::Lz4 ? "lz4" : "raw";
}

// Where chunks of the default payload are placed; nothing for other chunks.
std::vector<std::optional<Placement::Place>> places_of(const fb::PackIndex& index) {
  const PayloadMask mask = payload_closure(kDefaultPayload, index.grid_needs_scan());
  Placement placement;
  std::vector<std::optional<Placement::Place>> places;
  for (const fb::ChunkEntry* entry : *index.chunks()) {
    places.emplace_back();
    if ((mask & mask_of(entry->kind())) != 0) places.back() = placement.add(entry->decoded_size());
  }
  return places;
}

struct KindSum {
  std::uint64_t chunks = 0, stored = 0, decoded = 0;
};

std::array<KindSum, 32> sums_of(const fb::PackIndex& index) {
  std::array<KindSum, 32> sums{};
  for (const fb::ChunkEntry* entry : *index.chunks()) {
    KindSum& sum = sums[static_cast<std::size_t>(entry->kind())];
    ++sum.chunks;
    sum.stored += entry->stored_size();
    sum.decoded += entry->decoded_size();
  }
  return sums;
}

Json chunk_json(const fb::ChunkEntry& entry, const std::optional<Placement::Place>& place) {
  Json json;
  json["kind"] = kind_text(entry.kind());
  json["codec"] = codec_text(entry.codec());
  json["offset"] = entry.offset();
  json["stored_size"] = entry.stored_size();
  json["decoded_size"] = entry.decoded_size();
  json["first_signature"] = entry.first_signature();
  json["last_signature"] = entry.last_signature();
  json["bounds"] = {entry.min_x(), entry.min_y(), entry.max_x(), entry.max_y()};
  json["slot"] = place ? Json(place->slot) : Json();
  json["slot_offset"] = place ? Json(place->offset) : Json();
  return json;
}

void print(const PackReader& pack, const std::string& path, std::ostream& out) {
  const fb::PackIndex& index = pack.index();
  out << path << ": zone " << index.zone()->str() << ", "
      << counted(index.signatures(), "signature") << ", " << counted(index.features(), "feature")
      << ", " << size_text(pack.file().size()) << "\ndigest " << to_hex(pack.tail().digest)
      << (index.grid_needs_scan() ? "\ngrid cells are stored as points of the scan" : "") << "\n\n";
  TextTable kinds({"kind", "chunks", "decoded", "stored", "ratio"});
  const auto sums = sums_of(index);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (sums[k].chunks == 0) continue;
    kinds.add({kind_text(static_cast<fb::PayloadKind>(k)), std::to_string(sums[k].chunks),
               std::to_string(sums[k].decoded), std::to_string(sums[k].stored),
               ratio_text(sums[k].stored, sums[k].decoded)});
  }
  kinds.print(out);
  out << "\n";
  TextTable chunks({"chunk", "kind", "codec", "offset", "decoded", "stored", "ratio", "signatures",
                    "slot", "at"});
  const auto places = places_of(index);
  for (std::uint32_t i = 0; i < index.chunks()->size(); ++i) {
    const fb::ChunkEntry& entry = *index.chunks()->Get(i);
    chunks.add(
        {std::to_string(i), kind_text(entry.kind()), codec_text(entry.codec()),
         std::to_string(entry.offset()), std::to_string(entry.decoded_size()),
         std::to_string(entry.stored_size()), ratio_text(entry.stored_size(), entry.decoded_size()),
         std::to_string(entry.first_signature()) + ".." + std::to_string(entry.last_signature()),
         places[i] ? std::to_string(places[i]->slot) : "-",
         places[i] ? std::to_string(places[i]->offset) : "-"});
  }
  chunks.print(out);
  out << "\nslot, at: when " << payload_text(kDefaultPayload)
      << " are loaded; signatures: ordinals in the zone\n";
}

}  // namespace

nlohmann::ordered_json inspect_pack(const std::string& path, std::ostream& out) {
  const Result<PackReader> pack = PackReader::open(path);
  if (!pack) {
    const std::string kind = misplaced_map_file(path);
    if (!kind.empty()) throw std::runtime_error(path + ": " + kind);
    throw std::runtime_error(path + ": " + reason_text(pack.error()) +
                             "; to see where the pack is damaged: zonepack verify " +
                             shell_word(path));
  }
  const fb::PackIndex& index = pack->index();
  Json json;
  json["pack"] = path;
  json["zone"] = index.zone()->str();
  json["pack_bytes"] = pack->file().size();
  json["pack_digest"] = to_hex(pack->tail().digest);
  json["version"] = std::to_string(pack->tail().major) + "." + std::to_string(pack->tail().minor);
  json["slot_bytes"] = index.slot_bytes();
  json["signatures"] = index.signatures();
  json["features"] = index.features();
  json["grid_needs_scan"] = index.grid_needs_scan();
  json["slots"] = slots_needed(index, kDefaultPayload);
  json["payloads"] = Json::object();
  const auto sums = sums_of(index);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (sums[k].chunks == 0) continue;
    json["payloads"][kind_text(static_cast<fb::PayloadKind>(k))] = {
        {"chunks", sums[k].chunks},
        {"decoded_bytes", sums[k].decoded},
        {"stored_bytes", sums[k].stored}};
  }
  const auto places = places_of(index);
  json["chunks"] = Json::array();
  for (std::uint32_t i = 0; i < index.chunks()->size(); ++i) {
    json["chunks"].push_back(chunk_json(*index.chunks()->Get(i), places[i]));
  }
  print(*pack, path, out);
  return json;
}

}  // namespace zonepack::packer
