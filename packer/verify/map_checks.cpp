// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "packer/verify/manifest_checks.hpp"
#include "packer/zones/partition.hpp"
#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

using Packs = std::vector<std::optional<PackFacts>>;

std::string name_of(const fb::Manifest& manifest, std::uint32_t zone) {
  return manifest.zones()->Get(zone)->name()->str();
}

// The zone of every signature; reports signatures that are in two.
std::map<std::int32_t, std::uint32_t> zones_by_id(const fb::Manifest& manifest, const Packs& packs,
                                                  Contradictions& contradictions) {
  std::map<std::int32_t, std::uint32_t> zone_of;
  for (std::uint32_t zone = 0; zone < packs.size(); ++zone) {
    if (!packs[zone]) continue;
    for (const PackFacts::Node& node : packs[zone]->nodes) {
      const auto [found, inserted] = zone_of.emplace(node.id, zone);
      if (inserted) continue;
      contradictions.push_back("signature " + std::to_string(node.id) + " is in zone " +
                               name_of(manifest, found->second) + " and in zone " +
                               name_of(manifest, zone));
    }
  }
  return zone_of;
}

void check_edges(const fb::Manifest& manifest, const Packs& packs,
                 const std::map<std::int32_t, std::uint32_t>& zone_of,
                 Contradictions& contradictions) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> found;
  for (std::uint32_t zone = 0; zone < packs.size(); ++zone) {
    for (const auto& [from, to] : packs[zone]->links) {
      const auto other = zone_of.find(to);
      if (other != zone_of.end() && other->second != zone)
        ++found[std::minmax(zone, other->second)];
    }
  }
  const auto text = [&](std::uint32_t a, std::uint32_t b) {
    return "zones " + name_of(manifest, a) + " and " + name_of(manifest, b);
  };
  if (manifest.edges() != nullptr) {
    for (const fb::ZoneEdge* edge : *manifest.edges()) {
      const auto links = found.extract({edge->zone_a(), edge->zone_b()});
      const std::uint32_t held = links.empty() ? 0 : links.mapped();
      if (held == edge->links()) continue;
      contradictions.push_back("says " + std::to_string(edge->links()) + " links between " +
                               text(edge->zone_a(), edge->zone_b()) + ", the packs hold " +
                               std::to_string(held));
    }
  }
  for (const auto& [pair, links] : found) {
    contradictions.push_back("leaves out " + std::to_string(links) + " links between " +
                             text(pair.first, pair.second));
  }
}

double snap_of(const fb::Manifest& manifest) {
  const std::string options = flatbuffers::GetString(manifest.provenance()->options());
  const std::size_t at = options.find("snap=");
  double snap = kDefaultSnap_m;
  if (at != options.npos) {
    std::from_chars(options.data() + at + 5, options.data() + options.size(), snap);
  }
  return snap;
}

void check_portals(const fb::Manifest& manifest, Contradictions& contradictions) {
  if (manifest.portals() == nullptr) return;
  constexpr double kRounding_m = 1e-6;
  const double reach = snap_of(manifest) + kRounding_m;
  std::string previous;
  for (const fb::Portal* portal : *manifest.portals()) {
    const std::string name = flatbuffers::GetString(portal->name());
    if (name <= previous)
      contradictions.push_back("portal '" + name + "' is out of order or has no name");
    previous = name;
    for (const std::uint32_t zone : {portal->zone_a(), portal->zone_b()}) {
      const Polygon polygon = polygon_of(*manifest.zones()->Get(zone));
      for (const fb::Point* end : {portal->p(), portal->q()}) {
        const double off = distance_to_border_m(polygon, {end->x(), end->y()});
        if (off <= reach) continue;
        contradictions.push_back("portal '" + name + "' ends " + std::to_string(off) +
                                 " m off the border of zone " + name_of(manifest, zone));
      }
    }
  }
}

// Zones that an update added or drew anew. Other packs stay as they are then, with signatures that
// stand in such a zone by now.
std::set<std::string> zones_of_updates(const fb::Manifest& manifest) {
  std::set<std::string> names;
  if (manifest.changes() == nullptr) return names;
  for (const fb::Change* change : *manifest.changes()) {
    for (const auto* list : {change->added(), change->changed()}) {
      if (list == nullptr) continue;
      for (const flatbuffers::String* name : *list) names.insert(name->str());
    }
  }
  return names;
}

// Checks the zone-in rule among the zones as they were before they were split; parts of one zone
// share its signatures by a rule of their own.
void check_places(const fb::Manifest& manifest, const Packs& packs,
                  Contradictions& contradictions) {
  std::vector<PlannedZone> zones;
  for (const fb::Zone* zone : *manifest.zones()) {
    PlannedZone& planned = zones.emplace_back();
    planned.name = zone->name()->str();
    planned.parent = flatbuffers::GetString(zone->parent());
    planned.z_min_m = zone->z_min();
    planned.z_max_m = zone->z_max();
    planned.polygon = polygon_of(*zone);
  }
  std::vector<SignaturePlace> places;
  std::vector<std::uint32_t> holder;
  for (std::uint32_t zone = 0; zone < packs.size(); ++zone) {
    if (!packs[zone]) continue;
    for (const PackFacts::Node& node : packs[zone]->nodes) {
      const Transform& T = node.T_map_base;
      places.push_back({node.id, {T[3], T[7]}, T[11]});
      holder.push_back(zone);
    }
  }
  if (zones.empty()) return;
  const Partition partition = packer::partition(zones, places, OrphanPolicy::kNearest);
  std::set<SignatureId> orphans;
  for (const Orphan& orphan : partition.orphans) orphans.insert(orphan.id);
  const std::set<std::string> updated = zones_of_updates(manifest);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PlannedZone& by_rule = zones[partition.zone_of[i]];
    const PlannedZone& held = zones[holder[i]];
    if (partition.zone_of[i] == holder[i]) continue;
    if (!held.parent.empty() && (by_rule.parent == held.parent || orphans.contains(places[i].id))) {
      continue;
    }
    if (updated.contains(by_rule.name) || updated.contains(held.name)) continue;
    contradictions.push_back("signature " + std::to_string(places[i].id) +
                             " is in the pack of zone " + held.name +
                             ", by the polygons it belongs to zone " + by_rule.name);
  }
}

void check_provenance(const fb::Manifest& manifest, const Packs& packs,
                      Contradictions& contradictions) {
  const fb::Provenance& provenance = *manifest.provenance();
  constexpr std::uint64_t kFeatureRowBytes = 72;
  std::uint64_t features = 0;
  for (const auto& pack : packs) features += pack ? pack->features : 0;
  if (provenance.source_feature_count() < features) {
    contradictions.push_back("says the source had " +
                             std::to_string(provenance.source_feature_count()) +
                             " features, the packs hold " + std::to_string(features));
  }
  if (provenance.source_bytes() / kFeatureRowBytes < provenance.source_feature_count()) {
    contradictions.push_back("says the source had " + std::to_string(provenance.source_bytes()) +
                             " bytes, fewer than its features alone take");
  }
}

}  // namespace

Contradictions map_contradictions(const fb::Manifest& manifest, const Packs& packs) {
  Contradictions contradictions;
  if (manifest.frame()->str() != "map") {
    contradictions.push_back("says the frame is '" + manifest.frame()->str() +
                             "', it is always 'map'");
  }
  const auto zone_of = zones_by_id(manifest, packs, contradictions);
  const bool complete = std::all_of(packs.begin(), packs.end(),
                                    [](const auto& pack) { return pack && pack->complete; });
  if (complete) check_edges(manifest, packs, zone_of, contradictions);
  check_portals(manifest, contradictions);
  check_places(manifest, packs, contradictions);
  check_provenance(manifest, packs, contradictions);
  return contradictions;
}

}  // namespace zonepack::packer
