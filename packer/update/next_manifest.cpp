// SPDX-License-Identifier: Apache-2.0
#include "packer/update/next_manifest.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "packer/build/provenance.hpp"
#include "packer/build/zone_edges.hpp"
#include "packer/update/held_plan.hpp"

namespace zonepack::packer {
namespace {

std::string named(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

bool same_place(const PlannedZone& a, const PlannedZone& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return a.polygon.outer == b.polygon.outer && a.polygon.holes == b.polygon.holes &&
         a.z_min_m.value_or(-kInfinity) == b.z_min_m.value_or(-kInfinity) &&
         a.z_max_m.value_or(kInfinity) == b.z_max_m.value_or(kInfinity);
}

// Which zones are others than before.
void compare(const fb::Manifest& before, const ZoneContents& contents, const PackedZones& zones,
             UpdateSummary& summary) {
  std::set<std::string> now;
  for (std::uint32_t zone = 0; zone < contents.plan().zones.size(); ++zone) {
    const std::string& name = contents.plan().zones[zone].name;
    now.insert(name);
    const std::uint32_t held = index_of(contents.before(), name);
    if (held == ZoneContents::kNone) {
      summary.zones_added.push_back(name);
    } else {
      if (pack_of(*before.zones()->Get(held)).digest == zones.packs[zone].digest) {
        ++summary.zones_kept;
        continue;
      }
      summary.zones_changed.push_back(name);
    }
    summary.written_bytes += zones.packs[zone].bytes;
  }
  for (const PlannedZone& zone : contents.before().zones) {
    if (!now.contains(zone.name)) summary.zones_removed.push_back(zone.name);
  }
}

void count_signatures(const HeldSignatures& held, const PackedZones& zones,
                      const Newcomers* newcomers, UpdateSummary& summary) {
  summary.signatures_before = held.by_id().size();
  std::set<std::int32_t> now;
  for (const auto& zone : zones.nodes) {
    for (const fb::Node& node : zone) now.insert(node.id());
  }
  summary.signatures = now.size();
  for (const std::int32_t id : now) summary.signatures_added += held.find(id) == nullptr;
  for (const auto& [id, signature] : held.by_id()) {
    summary.signatures_removed += !now.contains(id);
  }
  if (newcomers == nullptr) return;
  for (const auto& [from, to] : newcomers->numbers().ids()) {
    if (now.contains(to)) summary.ids_mapped[from] = to;
  }
  for (const Newcomer& newcomer : newcomers->all()) {
    const std::int32_t before = newcomer.node->map_id;
    if (before != newcomer.session && now.contains(newcomer.id)) {
      summary.sessions_mapped[before] = newcomer.session;
    }
  }
}

std::vector<fb::ZoneEdge> edges_of(const HeldSignatures& held, const ZoneContents& contents,
                                   const PackedZones& zones, UpdateSummary& summary) {
  ZoneEdges edges(zones.nodes);
  const auto packed = [&](std::uint32_t zone) { return contents.contents()[zone].packed; };
  for (const auto& zone : zones.links) {
    for (const auto& [from, to] : zone) {
      const auto ends = edges.add(from, to);
      if (ends) summary.links_to_kept += packed(ends->first) != packed(ends->second);
    }
  }
  for (const auto& [id, signature] : held.by_id()) {
    const std::uint32_t zone = contents.place_of_held(signature.zone);
    if (zone == ZoneContents::kNone || packed(zone)) continue;
    for (const std::int32_t to : signature.links) {
      const auto ends = edges.add(id, to);
      if (ends) summary.links_to_kept += packed(ends->second);
    }
  }
  return edges.list();
}

}  // namespace

ManifestContent next_content(const fb::Manifest& manifest, const HeldSignatures& held,
                             const ZoneContents& contents, const ZonePlan& plan,
                             const PackedZones& zones, const MapSource* database,
                             const Newcomers* newcomers, UpdateSummary& summary) {
  compare(manifest, contents, zones, summary);
  count_signatures(held, zones, newcomers, summary);
  const fb::Provenance& before = *manifest.provenance();
  ManifestContent content;
  content.plan = &plan;
  content.packs = &zones.packs;
  content.nodes = zones.nodes;
  content.edges = edges_of(held, contents, zones, summary);
  std::copy(manifest.lineage()->begin(), manifest.lineage()->end(), content.lineage.begin());
  content.payload = manifest.payload_mask();
  content.source_kind = flatbuffers::GetString(before.source_kind());
  content.source_version = flatbuffers::GetString(before.source_version());
  content.options = flatbuffers::GetString(before.options());
  content.detector = flatbuffers::GetString(before.detector());
  content.source_feature_count = before.source_feature_count();
  content.source_bytes = before.source_bytes();
  content.changes = changes_of(manifest);
  const bool packs_changed = !summary.zones_added.empty() || !summary.zones_changed.empty();
  if (database == nullptr || !packs_changed) return content;
  const MapOutline& outline = database->outline();
  const SourceBytes source = source_bytes(outline);
  std::uint64_t features = 0;
  for (const PackSummary& pack : zones.packs) features += pack.features;
  // A database that was grown on holds what the map was packed from.
  if (newcomers->numbers().grown() && source.features >= features) {
    content.source_version = outline.schema_version;
    content.source_feature_count = source.features;
    content.source_bytes = source.bytes;
  } else {
    content.source_feature_count += source.features;
    content.source_bytes += source.bytes;
  }
  return content;
}

VersionChange change_since(const MapReader& before, const HeldSignatures& held,
                           const ZoneContents& contents, const UpdateOptions& options,
                           const UpdateSummary& summary) {
  VersionChange change;
  change.parent = manifest_digest(before.manifest_file());
  const auto say = [&change](const std::string& what) {
    change.what += (change.what.empty() ? "" : "; ") + what;
  };
  if (!options.replace.empty()) say("replace " + named(options.replace));
  if (options.add) say("add");
  for (const std::int32_t session : options.sessions.dropped) {
    say("drop-session " + std::to_string(session));
  }
  for (const NamedLayer& layer : options.layers) {
    say("layer " + layer.name + "=" + sessions_text(layer));
  }
  change.zones = before.manifest().zones()->size();
  change.signatures = held.by_id().size();
  for (const fb::Zone* zone : *before.manifest().zones()) change.pack_bytes += zone->pack_bytes();
  change.added = summary.zones_added;
  change.removed = summary.zones_removed;
  change.changed = summary.zones_changed;
  for (std::uint32_t zone = 0; zone < contents.contents().size(); ++zone) {
    const PlannedZone& now = contents.plan().zones[zone];
    const std::uint32_t before_at = index_of(contents.before(), now.name);
    if (before_at == ZoneContents::kNone) continue;  // added
    const PlannedZone& then = contents.before().zones[before_at];
    if (!same_place(now, then)) change.drawn.push_back(now.name);
    if (contents.contents()[zone].held == ZoneContents::kNone) change.replaced.push_back(now.name);
  }
  return change;
}

}  // namespace zonepack::packer
