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

template <typename Do>
void for_each_name(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* list,
                   Do with) {
  if (list == nullptr) return;
  for (const flatbuffers::String* name : *list) with(name->str());
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

// The number of the change that gave a zone its outline, and of the one that gave it all of its
// signatures or the first of them; 0: the build.
struct ZoneAge {
  std::uint32_t drawn = 0, filled = 0;
};

std::map<std::string, ZoneAge> ages_of(const fb::Manifest& manifest) {
  std::map<std::string, ZoneAge> ages;
  if (manifest.changes() == nullptr) return ages;
  std::uint32_t number = 0;
  for (const fb::Change* change : *manifest.changes()) {
    ++number;
    for_each_name(change->added(), [&](const std::string& zone) { ages[zone] = {number, number}; });
    for_each_name(change->drawn(), [&](const std::string& zone) { ages[zone] = {number, number}; });
    for_each_name(change->replaced(), [&](const std::string& zone) { ages[zone].filled = number; });
  }
  return ages;
}

std::vector<PlannedZone> zones_of(const fb::Manifest& manifest) {
  std::vector<PlannedZone> zones;
  for (const fb::Zone* zone : *manifest.zones()) {
    PlannedZone& planned = zones.emplace_back();
    planned.name = zone->name()->str();
    planned.parent = flatbuffers::GetString(zone->parent());
    planned.z_min_m = zone->z_min();
    planned.z_max_m = zone->z_max();
    planned.polygon = polygon_of(*zone);
  }
  return zones;
}

struct Held {
  SignaturePlace place;
  std::uint32_t zone = 0;
};

// Those that the zone-in rule gives to another zone than the one which holds them, with that one.
// The rule holds among zones as they were before they were split; parts of one zone share its
// signatures by a rule of their own. `places` are of zones among `zones`.
std::vector<std::pair<const Held*, std::uint32_t>> misplaced(
    const std::vector<PlannedZone>& zones, const std::vector<const Held*>& signatures,
    const std::vector<std::uint32_t>& place_of_zone) {
  std::vector<SignaturePlace> places;
  places.reserve(signatures.size());
  for (const Held* held : signatures) places.push_back(held->place);
  const Partition partition = packer::partition(zones, places, OrphanPolicy::kNearest);
  std::set<SignatureId> orphans;
  for (const Orphan& orphan : partition.orphans) orphans.insert(orphan.id);
  std::vector<std::pair<const Held*, std::uint32_t>> out;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::uint32_t here = place_of_zone[signatures[i]->zone], rule = partition.zone_of[i];
    if (rule == here) continue;
    const std::string& parent = zones[here].parent;
    if (!parent.empty() && (zones[rule].parent == parent || orphans.contains(places[i].id))) {
      continue;
    }
    out.emplace_back(signatures[i], rule);
  }
  return out;
}

// A zone that an update drew takes nothing from zones whose packs stay as they are, so signatures
// of these may stand in it by now. But among the zones that were drawn before the holder of a
// signature got the first of those it has, the rule must give the holder: leaving out zones that
// were drawn later, which at its time were others or none, takes the signature from no other zone.
//
// Not known: whether a signature came into its zone after another was drawn around it, as only
// zones are dated.
void check_places(const fb::Manifest& manifest, const Packs& packs,
                  Contradictions& contradictions) {
  const std::vector<PlannedZone> zones = zones_of(manifest);
  if (zones.empty()) return;
  std::vector<Held> all;
  for (std::uint32_t zone = 0; zone < packs.size(); ++zone) {
    if (!packs[zone]) continue;
    for (const PackFacts::Node& node : packs[zone]->nodes) {
      const Transform& T = node.T_map_base;
      all.push_back({{node.id, {T[3], T[7]}, T[11]}, zone});
    }
  }
  std::vector<const Held*> signatures;
  signatures.reserve(all.size());
  for (const Held& held : all) signatures.push_back(&held);
  std::vector<std::uint32_t> same(zones.size());
  for (std::uint32_t zone = 0; zone < same.size(); ++zone) same[zone] = zone;
  const auto report = [&](const Held& held, const std::string& rule) {
    contradictions.push_back("signature " + std::to_string(held.place.id) +
                             " is in the pack of zone " + zones[held.zone].name +
                             ", by the polygons it belongs to zone " + rule);
  };
  std::map<std::string, ZoneAge> ages = ages_of(manifest);
  std::map<std::uint32_t, std::vector<const Held*>> by_filling;
  for (const auto& [held, rule] : misplaced(zones, signatures, same)) {
    const std::uint32_t filled = ages[zones[held->zone].name].filled;
    if (ages[zones[rule].name].drawn <= filled) {
      report(*held, zones[rule].name);
    } else {
      by_filling[filled].push_back(held);
    }
  }
  for (const auto& [filled, later] : by_filling) {
    std::vector<PlannedZone> then;
    std::vector<std::uint32_t> place(zones.size());
    for (std::uint32_t zone = 0; zone < zones.size(); ++zone) {
      place[zone] = static_cast<std::uint32_t>(then.size());
      if (ages[zones[zone].name].drawn <= filled) then.push_back(zones[zone]);
    }
    for (const auto& [held, rule] : misplaced(then, later, place)) report(*held, then[rule].name);
  }
}

// The history leads from the zones that are there back to those of the first version.
//
// Not known: what the versions before had in signatures and bytes, as their packs may be gone.
void check_history(const fb::Manifest& manifest, Contradictions& contradictions) {
  if (manifest.changes() == nullptr) return;
  std::set<std::string> zones;
  for (const fb::Zone* zone : *manifest.zones()) zones.insert(zone->name()->str());
  for (std::uint32_t i = manifest.changes()->size(); i-- > 0;) {
    const fb::Change& change = *manifest.changes()->Get(i);
    const auto say = [&](const std::string& text) {
      contradictions.push_back("says in change number " + std::to_string(i + 1) + " " + text);
    };
    const auto check = [&](const auto* list, const char* word, bool there) {
      std::string last;
      for_each_name(list, [&](const std::string& zone) {
        if (zone <= last) say("that zones were " + std::string(word) + " out of order or twice");
        last = zone;
        if (zones.contains(zone) == there) return;
        say("that zone " + zone + " was " + word +
            (there ? ", and then has none" : ", and then has one") + " of that name");
      });
    };
    check(change.added(), "added", true);
    check(change.changed(), "changed", true);
    check(change.drawn(), "drawn", true);
    check(change.replaced(), "replaced", true);
    check(change.removed(), "removed", false);
    for_each_name(change.added(), [&](const std::string& zone) { zones.erase(zone); });
    for (const auto* list : {change.changed(), change.drawn(), change.replaced()}) {
      for_each_name(list, [&](const std::string& zone) {
        if (!zones.contains(zone)) say("that zone " + zone + " was there before, and was added");
      });
    }
    for_each_name(change.removed(), [&](const std::string& zone) { zones.insert(zone); });
    if (zones.size() != change.zones()) {
      say("there were " + std::to_string(change.zones()) + " zones before it, by its lists " +
          std::to_string(zones.size()));
    }
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
  check_history(manifest, contradictions);
  check_provenance(manifest, packs, contradictions);
  return contradictions;
}

}  // namespace zonepack::packer
