// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/catalog.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "platform/base/nearest_word.hpp"
#include "platform/files/storage.hpp"

namespace zonepack {
namespace {

std::string text_of(const flatbuffers::String* text) {
  return text == nullptr ? std::string() : text->str();
}

// Names that zones use, the first by name when there are more than an index can tell apart.
std::vector<std::string> layers_of_zones(const fb::Manifest& manifest) {
  std::set<std::string> names;
  for (const fb::Zone* zone : *manifest.zones()) {
    if (zone->layer() == nullptr || zone->layer()->size() == 0) continue;
    names.insert(zone->layer()->str());
    if (names.size() > CatalogZone::kNoLayer) names.erase(std::prev(names.end()));
  }
  return {names.begin(), names.end()};
}

Failure no_room_failure(ByteCount need, ByteCount most) {
  return failure("reading it and holding its tables takes " + format_byte_count(need) +
                     ", over the " + format_byte_count(most) + " that there is for it",
                 ErrorCode::kNoRoom);
}

}  // namespace

Outcome<std::vector<std::byte>> read_manifest_file(const std::string& folder, ByteCount most,
                                                   ReadMode mode) {
  const std::uint64_t limit = std::min(kMaxManifestFileBytes, most / kManifestHeldTimes);
  auto file = read_file(folder + "/" + std::string(kManifestName), limit, mode);
  if (file) return std::move(file).value();
  const Error& error = file.error();
  if (error.code != ErrorCode::kTooLarge) return failure(reason_text(error), error.code);
  const auto size = static_cast<ByteCount>(error.detail);
  if (size > kMaxManifestFileBytes) {
    return failure(to_string(Excess{LimitId::kManifestBytes, size - kManifestFrameBytes}),
                   error.code);
  }
  return no_room_failure(kManifestHeldTimes * size, most);
}

Outcome<Catalog> Catalog::open(const std::string& folder, PayloadMask payload, ByteCount most) {
  const auto file = read_manifest_file(folder, most, ReadMode::kBuffered);
  if (!file) return file.error();
  return read(*file, folder, payload, most);
}

Outcome<Catalog> Catalog::read(ByteSpan file, const std::string& folder, PayloadMask payload,
                               ByteCount most) {
  ManifestFault fault;
  const Result<const fb::Manifest*> checked = check_manifest(file, &fault);
  if (!checked) {
    return failure(manifest_fault_text(checked.error(), fault), checked.error().code);
  }
  const ByteCount need = kManifestHeldTimes * file.size() + table_bytes(**checked);
  if (need > most) return no_room_failure(need, most);
  const fb::Manifest& manifest = **checked;

  Catalog catalog;
  catalog.folder = folder;
  std::copy(manifest.lineage()->begin(), manifest.lineage()->end(), catalog.lineage.begin());
  catalog.version = manifest_digest(file);
  if (const auto* const detector = manifest.provenance()->detector();
      detector != nullptr && detector->size() <= kMostDetectorBytes) {
    catalog.detector = detector->str();
  }
  catalog.payload = payload;
  const MapCosts costs = map_costs(manifest, file.size(), payload);
  catalog.fixed_bytes = costs.fixed_bytes;
  catalog.reading_bytes = kManifestHeldTimes * file.size();
  catalog.zones.reserve(manifest.zones()->size());
  catalog.layers = layers_of_zones(manifest);
  for (const fb::Zone* zone : *manifest.zones()) {
    CatalogZone& entry = catalog.zones.emplace_back();
    entry.name = zone->name()->str();
    entry.zone_type = text_of(zone->zone_type());
    if (zone->layer() != nullptr) {
      const auto layer = std::ranges::lower_bound(catalog.layers, zone->layer()->string_view());
      if (layer != catalog.layers.end() && *layer == zone->layer()->string_view()) {
        entry.layer = static_cast<std::uint8_t>(layer - catalog.layers.begin());
      }
    }
    entry.polygon = polygon_of(*zone);
    entry.signatures = zone->signatures();
    entry.slots = costs.zone_slots[catalog.zones.size() - 1];
    const PayloadMask mask = payload_closure(payload, zone->grid_needs_scan());
    for (const fb::PayloadBytes* bytes : *zone->payloads()) {
      if ((mask & mask_of(static_cast<fb::PayloadKind>(bytes->kind()))) == 0) continue;
      entry.stored_bytes += bytes->stored();
      entry.decoded_bytes += bytes->decoded();
    }
    entry.chunks = chunk_count(*zone);
    entry.pack = zone->pack()->str();
    entry.pack_bytes = zone->pack_bytes();
    std::copy(zone->pack_digest()->begin(), zone->pack_digest()->end(), entry.pack_digest.begin());
  }
  if (manifest.portals() != nullptr) {
    catalog.portals.reserve(manifest.portals()->size());
    for (const fb::Portal* portal : *manifest.portals()) {
      catalog.portals.push_back(
          {text_of(portal->name()),
           portal->zone_a(),
           portal->zone_b(),
           {{portal->p()->x(), portal->p()->y()}, {portal->q()->x(), portal->q()->y()}}});
    }
  }
  return catalog;
}

MapCosts Catalog::costs() const {
  MapCosts costs;
  costs.fixed_bytes = fixed_bytes;
  for (const CatalogZone& zone : zones) costs.zone_slots.push_back(zone.slots);
  for (const CatalogPortal& portal : portals) {
    costs.neighbours.emplace_back(portal.zone_a, portal.zone_b);
  }
  return costs;
}

Outcome<void> Catalog::choose_layers(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  for (const std::string& name : names) {
    if (std::ranges::binary_search(layers, name)) continue;
    return failure("memory.layers: no zone of the map " + folder + " is of layer " + name +
                       (layers.empty() ? "; none has a layer: name them with zonepack build "
                                         "--layer or zonepack update --layer"
                                       : known_words_text(name, layers)),
                   ErrorCode::kNotFound);
  }
  for (CatalogZone& zone : zones) {
    if (zone.layer == CatalogZone::kNoLayer ||
        std::ranges::find(names, layers[zone.layer]) != names.end()) {
      continue;
    }
    zone.loadable = false;
    zone.slots = zone.signatures = 0;
  }
  return {};
}

ZoneId Catalog::find(std::string_view name) const noexcept {
  const auto found = std::lower_bound(
      zones.begin(), zones.end(), name,
      [](const CatalogZone& zone, std::string_view wanted) { return zone.name < wanted; });
  if (found == zones.end() || found->name != name) return kNoZone;
  return static_cast<ZoneId>(found - zones.begin());
}

}  // namespace zonepack
