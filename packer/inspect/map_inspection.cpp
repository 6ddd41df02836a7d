// SPDX-License-Identifier: Apache-2.0
#include "packer/inspect/map_inspection.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "packer/console/text_table.hpp"
#include "packer/console/words.hpp"
#include "packer/decode/map_reader.hpp"
#include "packer/verify/problem.hpp"
#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack::packer {
namespace {

using Json = nlohmann::ordered_json;

Json text_or_null(const flatbuffers::String* text) {
  return text == nullptr ? Json() : Json(text->str());
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::string hex_of(const flatbuffers::Vector<std::uint8_t>& bytes) {
  return to_hex(std::span(bytes.data(), bytes.size()));
}

struct ZoneBytes {
  ByteCount charged = 0, stored = 0, decoded = 0;  // for the default payload
};

ZoneBytes bytes_of(const fb::Manifest& manifest, const fb::Zone& zone) {
  const ChunkBytes chunks = chunk_bytes(zone, kDefaultPayload);
  return {.charged = zone_slots(manifest, zone, kDefaultPayload) * kSlotBytes,
          .stored = chunks.stored,
          .decoded = chunks.decoded};
}

Json zone_json(const fb::Manifest& manifest, const fb::Zone& zone) {
  const ZoneBytes bytes = bytes_of(manifest, zone);
  Json json;
  json["name"] = zone.name()->str();
  json["zone_type"] = text_or_null(zone.zone_type());
  json["label"] = text_or_null(zone.label());
  json["parent"] = text_or_null(zone.parent());
  json["layer"] = text_or_null(zone.layer());
  json["floor"] = text_or_null(zone.floor());
  json["z_min"] = finite_or_null(zone.z_min());
  json["z_max"] = finite_or_null(zone.z_max());
  json["area_m2"] = area_m2(polygon_of(zone));
  json["signatures"] = zone.signatures();
  json["features"] = zone.features();
  json["slots"] = zone_slots(manifest, zone, kDefaultPayload);
  json["charged_bytes"] = bytes.charged;
  json["decoded_bytes"] = bytes.decoded;
  json["stored_bytes"] = bytes.stored;
  json["pack"] = zone.pack()->str();
  json["pack_bytes"] = zone.pack_bytes();
  json["pack_digest"] = hex_of(*zone.pack_digest());
  json["grid_needs_scan"] = zone.grid_needs_scan();
  json["payloads"] = Json::object();
  for (const fb::PayloadBytes* payload : *zone.payloads()) {
    json["payloads"][kind_text(static_cast<fb::PayloadKind>(payload->kind()))] = {
        {"chunks", payload->chunks()},
        {"decoded_bytes", payload->decoded()},
        {"stored_bytes", payload->stored()}};
  }
  return json;
}

Json portals_json(const fb::Manifest& manifest) {
  Json json = Json::array();
  if (manifest.portals() == nullptr) return json;
  const auto name_of = [&](std::uint32_t zone) {
    return manifest.zones()->Get(zone)->name()->str();
  };
  for (const fb::Portal* portal : *manifest.portals()) {
    json.push_back({{"name", text_or_null(portal->name())},
                    {"zones", {name_of(portal->zone_a()), name_of(portal->zone_b())}},
                    {"p", {portal->p()->x(), portal->p()->y()}},
                    {"q", {portal->q()->x(), portal->q()->y()}}});
  }
  return json;
}

Json layers_json(const fb::Manifest& manifest) {
  Json json = Json::array();
  if (manifest.layers() == nullptr) return json;
  for (const fb::Layer* layer : *manifest.layers()) {
    Json sessions = Json::array();
    for (const fb::SessionRange* range : *layer->sessions()) {
      sessions.push_back({range->first(), range->last()});
    }
    json.push_back({{"name", layer->name()->str()}, {"sessions", std::move(sessions)}});
  }
  return json;
}

// "8 Kp/MaxFeatures:400;GFTT/BlockSize:3": the detector, and its settings where the source has any.
Json detector_part(const flatbuffers::String* text, bool settings) {
  if (text == nullptr) return nullptr;
  const std::string all = text->str();
  const std::size_t blank = all.find(' ');
  if (!settings) return all.substr(0, blank);
  return blank == std::string::npos ? Json() : Json(all.substr(blank + 1));
}

Json provenance_json(const fb::Provenance& provenance) {
  return {{"source_kind", text_or_null(provenance.source_kind())},
          {"source_version", text_or_null(provenance.source_version())},
          {"packer_version", text_or_null(provenance.packer_version())},
          {"lz4_version", provenance.lz4_version()},
          {"options", text_or_null(provenance.options())},
          {"source_feature_count", provenance.source_feature_count()},
          {"source_bytes", provenance.source_bytes()},
          {"detector", detector_part(provenance.detector(), false)},
          {"detector_settings", detector_part(provenance.detector(), true)}};
}

void print(const fb::Manifest& manifest, const std::string& folder, const std::string& version,
           std::ostream& out) {
  const std::uint32_t portals = manifest.portals() == nullptr ? 0 : manifest.portals()->size();
  out << folder << ": map " << hex_of(*manifest.lineage()) << ", version " << version << "\n"
      << counted(manifest.zones()->size(), "zone") << ", " << counted(portals, "portal")
      << ", payload " << payload_text(manifest.payload_mask()) << ", slots of "
      << manifest.slot_bytes() << " bytes\n\n";
  TextTable table(
      {"zone", "type", "signatures", "features", "slots", "charged MiB", "stored MiB", "pack"});
  std::uint64_t signatures = 0, features = 0, slots = 0;
  ZoneBytes total;
  std::vector<std::string> names;
  for (const fb::Zone* zone : *manifest.zones()) names.push_back(zone->name()->str());
  for (const std::size_t i : natural_order(names)) {
    const fb::Zone* const zone = manifest.zones()->Get(static_cast<flatbuffers::uoffset_t>(i));
    const ZoneBytes bytes = bytes_of(manifest, *zone);
    const std::uint32_t zone_slots = zonepack::zone_slots(manifest, *zone, kDefaultPayload);
    table.add({zone->name()->str(), zone->zone_type() == nullptr ? "" : zone->zone_type()->str(),
               std::to_string(zone->signatures()), std::to_string(zone->features()),
               std::to_string(zone_slots), mib_text(bytes.charged), mib_text(bytes.stored),
               zone->pack()->str()});
    signatures += zone->signatures();
    features += zone->features();
    slots += zone_slots;
    total.charged += bytes.charged;
    total.stored += bytes.stored;
  }
  table.add({"all", "", std::to_string(signatures), std::to_string(features), std::to_string(slots),
             mib_text(total.charged), mib_text(total.stored), ""});
  table.print(out);
  out << "\nslots, charged and stored: for " << payload_text(kDefaultPayload)
      << "; the 16 digits in a pack's name begin its digest\n";
}

}  // namespace

nlohmann::ordered_json inspect_map(const std::string& folder, std::ostream& out) {
  const MapReader map(folder);
  const fb::Manifest& manifest = map.manifest();
  const std::string version = to_hex(manifest_digest(map.manifest_file()));
  Json json;
  json["map"] = folder;
  json["lineage"] = hex_of(*manifest.lineage());
  json["version"] = version;
  json["frame"] = manifest.frame()->str();
  json["slot_bytes"] = manifest.slot_bytes();
  json["payload"] = payload_text(manifest.payload_mask());
  json["manifest_bytes"] = map.manifest_file().size();
  json["signed"] = manifest.signature() != nullptr;
  json["zones"] = Json::array();
  for (const fb::Zone* zone : *manifest.zones())
    json["zones"].push_back(zone_json(manifest, *zone));
  json["layers"] = layers_json(manifest);
  json["portals"] = portals_json(manifest);
  json["provenance"] = provenance_json(*manifest.provenance());
  print(manifest, folder, version, out);
  return json;
}

}  // namespace zonepack::packer
