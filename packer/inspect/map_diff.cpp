// SPDX-License-Identifier: Apache-2.0
#include "packer/inspect/map_diff.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

namespace zonepack::packer {
namespace {

std::string digest_of(const fb::Zone& zone) {
  return to_hex(std::span(zone.pack_digest()->data(), zone.pack_digest()->size()));
}

// All that the manifest says of a zone besides its pack.
bool drawn_alike(const fb::Zone& a, const fb::Zone& b) {
  const auto texts = [](const fb::Zone& zone) {
    return std::tuple(flatbuffers::GetString(zone.zone_type()),
                      flatbuffers::GetString(zone.label()), flatbuffers::GetString(zone.parent()),
                      flatbuffers::GetString(zone.layer()), flatbuffers::GetString(zone.floor()),
                      zone.z_min(), zone.z_max());
  };
  const Polygon p = polygon_of(a), q = polygon_of(b);
  return texts(a) == texts(b) && p.outer == q.outer && p.holes == q.holes;
}

using PortalKey = std::tuple<std::string, std::string, std::string, double, double, double, double>;

std::set<PortalKey> portals_of(const fb::Manifest& manifest) {
  std::set<PortalKey> portals;
  if (manifest.portals() == nullptr) return portals;
  for (const fb::Portal* portal : *manifest.portals()) {
    portals.emplace(flatbuffers::GetString(portal->name()),
                    manifest.zones()->Get(portal->zone_a())->name()->str(),
                    manifest.zones()->Get(portal->zone_b())->name()->str(), portal->p()->x(),
                    portal->p()->y(), portal->q()->x(), portal->q()->y());
  }
  return portals;
}

std::vector<std::tuple<std::string, std::int32_t, std::int32_t>> layers_of_map(
    const fb::Manifest& manifest) {
  std::vector<std::tuple<std::string, std::int32_t, std::int32_t>> layers;
  if (manifest.layers() == nullptr) return layers;
  for (const fb::Layer* layer : *manifest.layers()) {
    for (const fb::SessionRange* range : *layer->sessions()) {
      layers.emplace_back(layer->name()->str(), range->first(), range->last());
    }
  }
  return layers;
}

std::size_t missing_from(const std::set<PortalKey>& these, const std::set<PortalKey>& those) {
  return static_cast<std::size_t>(
      std::ranges::count_if(these, [&](const PortalKey& key) { return !those.contains(key); }));
}

}  // namespace

MapDiff diff_maps(const MapReader& before, const MapReader& after) {
  const fb::Manifest &a = before.manifest(), &b = after.manifest();
  MapDiff diff;
  diff.version_before = to_hex(manifest_digest(before.manifest_file()));
  diff.version_after = to_hex(manifest_digest(after.manifest_file()));
  diff.same_map = std::ranges::equal(*a.lineage(), *b.lineage());
  std::map<std::string, std::pair<const fb::Zone*, const fb::Zone*>> zones;
  std::set<std::string> packs;  // of the map before, by digest
  for (const fb::Zone* zone : *a.zones()) {
    zones[zone->name()->str()].first = zone;
    packs.insert(digest_of(*zone));
    diff.signatures_before += zone->signatures();
    diff.pack_bytes_before += zone->pack_bytes();
  }
  for (const fb::Zone* zone : *b.zones()) {
    zones[zone->name()->str()].second = zone;
    diff.signatures_after += zone->signatures();
    diff.pack_bytes_after += zone->pack_bytes();
  }
  for (const auto& [name, pair] : zones) {
    const auto& [old_zone, new_zone] = pair;
    ZoneDiff zone;
    zone.name = name;
    if (old_zone != nullptr) {
      zone.signatures_before = old_zone->signatures();
      zone.pack_bytes_before = old_zone->pack_bytes();
    }
    if (new_zone != nullptr) {
      zone.signatures_after = new_zone->signatures();
      zone.pack_bytes_after = new_zone->pack_bytes();
    }
    if (old_zone == nullptr) {
      zone.kind = ZoneDiff::Kind::kAdded;
    } else if (new_zone == nullptr) {
      zone.kind = ZoneDiff::Kind::kRemoved;
    } else if (digest_of(*old_zone) != digest_of(*new_zone)) {
      zone.kind = ZoneDiff::Kind::kChanged;
    } else if (!drawn_alike(*old_zone, *new_zone)) {
      zone.kind = ZoneDiff::Kind::kRedrawn;
    } else {
      ++diff.unchanged;
      continue;
    }
    if (new_zone != nullptr && !packs.contains(digest_of(*new_zone))) {
      zone.pack = new_zone->pack()->str();
      ++diff.fetch_packs;
      diff.fetch_pack_bytes += new_zone->pack_bytes();
    }
    diff.zones.push_back(std::move(zone));
  }
  const auto portals_before = portals_of(a), portals_after = portals_of(b);
  diff.portals_added = missing_from(portals_after, portals_before);
  diff.portals_removed = missing_from(portals_before, portals_after);
  diff.layers_changed = layers_of_map(a) != layers_of_map(b);
  if (diff.version_before != diff.version_after) {
    diff.fetch_manifest_bytes = after.manifest_file().size();
  }
  return diff;
}

}  // namespace zonepack::packer
