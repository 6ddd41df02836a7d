// SPDX-License-Identifier: Apache-2.0
#include "packer/update/held_plan.hpp"

#include <algorithm>
#include <cmath>

namespace zonepack::packer {
namespace {

std::vector<std::string> names_in(
    const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* list) {
  std::vector<std::string> names;
  if (list == nullptr) return names;
  for (const flatbuffers::String* name : *list) names.push_back(name->str());
  return names;
}

std::optional<double> bound(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

ZonePlan plan_of(const fb::Manifest& manifest) {
  ZonePlan plan;
  for (const fb::Zone* zone : *manifest.zones()) {
    plan.zones.push_back({.name = zone->name()->str(),
                          .parent = flatbuffers::GetString(zone->parent()),
                          .zone_type = flatbuffers::GetString(zone->zone_type()),
                          .label = flatbuffers::GetString(zone->label()),
                          .layer = flatbuffers::GetString(zone->layer()),
                          .floor = flatbuffers::GetString(zone->floor()),
                          .z_min_m = bound(zone->z_min()),
                          .z_max_m = bound(zone->z_max()),
                          .polygon = polygon_of(*zone)});
  }
  if (manifest.portals() == nullptr) return plan;
  for (const fb::Portal* portal : *manifest.portals()) {
    plan.portals.push_back(
        {flatbuffers::GetString(portal->name()),
         portal->zone_a(),
         portal->zone_b(),
         {{portal->p()->x(), portal->p()->y()}, {portal->q()->x(), portal->q()->y()}}});
  }
  return plan;
}

PackSummary pack_of(const fb::Zone& zone) {
  PackSummary pack;
  pack.file = zone.pack()->str();
  pack.bytes = zone.pack_bytes();
  std::copy(zone.pack_digest()->begin(), zone.pack_digest()->end(), pack.digest.begin());
  pack.signatures = zone.signatures();
  pack.features = zone.features();
  pack.grid_needs_scan = zone.grid_needs_scan();
  for (const fb::PayloadBytes* payload : *zone.payloads()) {
    if (payload->kind() >= kPayloadKinds) continue;
    pack.payloads[payload->kind()] = {payload->decoded(), payload->stored(), payload->chunks()};
  }
  pack.slots.assign(zone.slots()->begin(), zone.slots()->end());
  return pack;
}

std::vector<NamedLayer> layers_of(const fb::Manifest& manifest) {
  std::vector<NamedLayer> layers;
  if (manifest.layers() == nullptr) return layers;
  for (const fb::Layer* layer : *manifest.layers()) {
    NamedLayer& named = layers.emplace_back();
    named.name = layer->name()->str();
    for (const fb::SessionRange* range : *layer->sessions()) {
      named.sessions.emplace_back(range->first(), range->last());
    }
  }
  return layers;
}

std::vector<VersionChange> changes_of(const fb::Manifest& manifest) {
  std::vector<VersionChange> changes;
  if (manifest.changes() == nullptr) return changes;
  for (const fb::Change* change : *manifest.changes()) {
    VersionChange& out = changes.emplace_back();
    std::copy(change->parent()->begin(), change->parent()->end(), out.parent.begin());
    out.what = change->what()->str();
    out.zones = change->zones();
    out.signatures = change->signatures();
    out.pack_bytes = change->pack_bytes();
    out.added = names_in(change->added());
    out.removed = names_in(change->removed());
    out.changed = names_in(change->changed());
    out.drawn = names_in(change->drawn());
    out.replaced = names_in(change->replaced());
  }
  return changes;
}

}  // namespace zonepack::packer
