// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/held_map.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "packer/decode/zone_records.hpp"
#include "packer/encode/pack_writer.hpp"
#include "packer/update/held_plan.hpp"

namespace zonepack::packer::tune {
namespace {

// The share of each signature in the chunks of these kinds.
void share_out(const MapReader& map, ZoneId zone, PayloadMask wanted,
               std::span<Signature* const> signatures) {
  const PackReader pack = map.open_pack(*map.manifest().zones()->Get(zone));
  for (const fb::ChunkEntry* chunk : *pack.index().chunks()) {
    if ((wanted & mask_of(chunk->kind())) == 0) continue;
    const std::uint32_t first = chunk->first_signature(), last = chunk->last_signature();
    if (last < first || last >= signatures.size()) continue;
    const double share = static_cast<double>(chunk->decoded_size()) / (last - first + 1);
    for (std::uint32_t i = first; i <= last; ++i) signatures[i]->decoded += share;
  }
}

}  // namespace

HeldMap read_held_map(const MapReader& map, const std::string& folder, PayloadMask payload,
                      std::span<const ZoneId> pinned, const std::vector<std::string>& layers) {
  const fb::Manifest& manifest = map.manifest();
  if (flatbuffers::GetString(manifest.provenance()->source_kind()) == "pcd") {
    throw std::runtime_error(folder +
                             ": is packed from a point cloud, whose tiles are cut anew along the "
                             "borders of zones, so what other zones charge shows only when it is "
                             "packed with them; split zones with zonepack build --max-zone-bytes");
  }
  HeldMap held;
  const ZonePlan plan = plan_of(manifest);
  const std::uint32_t count = manifest.zones()->size();
  for (ZoneId id = 0; id < count; ++id) {
    const fb::Zone& zone = *manifest.zones()->Get(id);
    const std::size_t nodes = zone.nodes() == nullptr ? 0 : zone.nodes()->size();
    if (nodes != zone.signatures()) {
      throw std::runtime_error(
          folder + ": the manifest has the places of " + std::to_string(nodes) + " of the " +
          std::to_string(zone.signatures()) + " signatures of zone '" + zone.name()->str() +
          "', so nothing says in which part of it they are; build the map "
          "again with this zonepack");
    }
    if (zone.nodes() == nullptr) continue;
    for (const fb::Node* node : *zone.nodes()) {
      held.signatures.push_back({{node->id(), {node->x(), node->y()}, node->z()}, id, 0});
    }
  }
  if (held.signatures.empty()) {
    throw std::runtime_error(folder + ": holds no signatures, so no zone costs anything");
  }
  std::ranges::sort(held.signatures, {}, [](const Signature& s) { return s.place.id; });
  std::vector<std::vector<Signature*>> of_zone(count);
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::uint32_t i = 0; i < held.signatures.size(); ++i) {
    of_zone[held.signatures[i].pack].push_back(&held.signatures[i]);
    members[held.signatures[i].pack].push_back(i);
  }
  const MapCosts costs = map_costs(manifest, map.manifest_file().size(), payload);
  for (ZoneId id = 0; id < count; ++id) {
    const fb::Zone& zone = *manifest.zones()->Get(id);
    share_out(map, id, payload_closure(payload, zone.grid_needs_scan()), of_zone[id]);
    TunedZone& tuned = held.layout.zones.emplace_back();
    tuned.zone = plan.zones[id];
    tuned.members = std::move(members[id]);
    tuned.cost = {costs.zone_slots[id], chunk_count(zone), chunk_bytes(zone, payload).stored, true};
    tuned.pinned = std::ranges::find(pinned, id) != pinned.end();
    tuned.loaded = layers.empty() || tuned.zone.layer.empty() ||
                   std::ranges::find(layers, tuned.zone.layer) != layers.end();
  }
  held.layout.portals = plan.portals;
  held.layout.other_fixed_bytes = costs.fixed_bytes - held.layout.fixed_bytes();
  return held;
}

PackScale::PackScale(const MapReader& map, PayloadMask payload) : map_(map), payload_(payload) {
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  std::string pattern = (temporary / "zonepack-tune-XXXXXX").string();
  if (error || mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error(pattern +
                             ": cannot create a folder to weigh zones in; set TMPDIR to a folder "
                             "that is writable");
  }
  folder_ = pattern;
}

PackScale::~PackScale() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

PackCost PackScale::weigh(const TunedZone& zone, std::span<const Signature> signatures) const {
  std::set<ZoneId> packs;
  std::map<std::int32_t, const Signature*> wanted;
  for (const std::uint32_t i : zone.members) {
    packs.insert(signatures[i].pack);
    wanted[signatures[i].place.id] = &signatures[i];
  }
  std::map<std::int32_t, SignatureRecord> records;
  // Chunks of all kinds by default share slots, whichever are loaded.
  const PayloadMask held_kinds = map_.manifest().payload_mask();
  const PayloadMask kinds = kCoreOnly | payload_ | (kDefaultPayload & held_kinds);
  for (const ZoneId pack : packs) {
    ZoneRecords reader(map_, *map_.manifest().zones()->Get(pack), kinds);
    for (SignatureRecord record; reader.next(record); record = {}) {
      if (wanted.contains(record.id)) records.insert_or_assign(record.id, std::move(record));
    }
  }
  PackWriter writer(folder_, "part");
  for (auto& [id, record] : records) {
    const Point2 p = wanted.at(id)->place.p_map;
    writer.add(record, static_cast<float>(p.x_m), static_cast<float>(p.y_m));
  }
  const PackSummary summary = writer.finish(kinds);
  std::error_code ignored;
  std::filesystem::remove(folder_ / summary.file, ignored);
  PackCost cost{.slots = 0, .chunks = 0, .stored = 0, .exact = true};
  const PayloadMask loaded = payload_closure(payload_, summary.grid_needs_scan);
  cost.slots = summary.slots[slot_table_index(loaded, kinds)];
  for (std::size_t kind = 0; kind < kPayloadKinds; ++kind) {
    cost.chunks += summary.payloads[kind].chunks;
    if ((loaded & mask_of(static_cast<fb::PayloadKind>(kind))) != 0) {
      cost.stored += summary.payloads[kind].stored;
    }
  }
  // Of other kinds it has as many as their share.
  if ((held_kinds & ~kinds) != 0) cost.chunks = std::max(cost.chunks, zone.cost.chunks);
  return cost;
}

}  // namespace zonepack::packer::tune
