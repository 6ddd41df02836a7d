// SPDX-License-Identifier: Apache-2.0
#include "packer/update/zone_packing.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "packer/build/payload_set.hpp"
#include "packer/build/zone_jobs.hpp"
#include "packer/decode/zone_records.hpp"
#include "packer/encode/packable.hpp"
#include "packer/record/link_order.hpp"
#include "packer/update/held_plan.hpp"

namespace zonepack::packer {

PackedZones ZonePacking::pack(MapSource* database, const Newcomers* newcomers, MapFolder& folder,
                              std::vector<Damage>& damages, Progress& progress) {
  newcomers_ = newcomers;
  if (newcomers != nullptr) {
    for (const Damage& damage : damages) {
      skipped_.insert(newcomers->numbers().id(damage.signature));
    }
  }
  const std::size_t zones = zones_.contents().size();
  out_.packs.resize(zones);
  out_.nodes.resize(zones);
  out_.links.resize(zones);
  out_.sessions.resize(zones);
  std::vector<std::uint32_t> order;
  for (std::uint32_t zone = 0; zone < zones; ++zone) {
    if (zones_.contents()[zone].packed) {
      order.push_back(zone);
    } else {
      keep(zone);
    }
  }
  for (const auto& [id, signature] : held_.by_id()) {
    const std::uint32_t zone = zones_.place_of_held(signature.zone);
    if (zone == ZoneContents::kNone || zones_.contents()[zone].packed) continue;
    ++out_.sessions[zone][signature.session];
  }
  progress.start("packing", order.size(), "zones");
  run_zone_jobs(order.size(), options_.jobs, database, [&](MapSource* source, std::size_t i) {
    pack_zone(source, folder, order[i], damages);
    progress.advance();
  });
  if (database != nullptr) database->require_unchanged();
  refuse_damaged(damages, options_.damaged, options_.source.name());
  progress.finish(std::to_string(order.size()) + (order.size() == 1 ? " zone" : " zones"));
  return std::move(out_);
}

void ZonePacking::keep(std::uint32_t zone) {
  const fb::Zone& held = *manifest_.zones()->Get(zones_.contents()[zone].held);
  out_.packs[zone] = pack_of(held);
  if (held.nodes() == nullptr) return;
  for (const fb::Node* node : *held.nodes()) out_.nodes[zone].push_back(*node);
}

// A signature that the map keeps may have been linked to new ones since.
void ZonePacking::add_links_to_newcomers(MapSource& database, SignatureRecord& record) const {
  const std::optional<std::int32_t> id = newcomers_->numbers().in_database(record.id);
  if (!id || database.outline().find(*id)->damaged) return;
  constexpr PayloadSet kNothing{false, false, false, false, false, false};
  SignatureRecord now = database.read(*id, kNothing);
  newcomers_->numbers().apply(now);
  for (Link& link : now.links) {
    const bool known = std::ranges::any_of(record.links, [&](const Link& held) {
      return held.to == link.to && held.type == link.type;
    });
    if (!known && zones_.takes(link.to)) record.links.push_back(std::move(link));
  }
  sort_links(record.links);
}

// False when it is damaged.
bool ZonePacking::read_newcomer(MapSource& database, const Newcomer& newcomer,
                                SignatureRecord& into, std::vector<Damage>& damages) {
  const std::int32_t id = newcomer.node->id;
  try {
    database.read(id, payload_set(manifest_.payload_mask()), into);
  } catch (const DamagedSignature& damaged) {
    const std::lock_guard lock(mutex_);
    damages.push_back(damaged.damage());
    return false;
  }
  if (const auto unpackable = find_unpackable(into)) {
    const std::lock_guard lock(mutex_);
    damages.push_back({id, unpackable->column, unpackable->problem});
    return false;
  }
  newcomers_->numbers().apply(into);
  if (into.pose) into.pose = newcomer.T_map_base;
  return true;
}

void ZonePacking::pack_zone(MapSource* database, MapFolder& folder, std::uint32_t zone,
                            std::vector<Damage>& damages) {
  const ZoneContents::Content& content = zones_.contents()[zone];
  PackWriter writer(folder.path(), zones_.plan().zones[zone].name,
                    pack_minor(manifest_.payload_mask()));
  const auto add = [&](SignatureRecord& record, const fb::Node& node) {
    ++out_.sessions[zone][record.map_id];
    for (const Link& link : record.links) out_.links[zone].emplace_back(record.id, link.to);
    out_.nodes[zone].push_back(node);
    writer.add(record, node.x(), node.y());
  };
  std::optional<ZoneRecords> records;
  const fb::Zone* held = nullptr;
  SignatureRecord record;
  std::uint32_t ordinal = 0;
  bool more = false;
  if (content.held != ZoneContents::kNone) {
    held = manifest_.zones()->Get(content.held);
    records.emplace(map_, *held);
    more = records->next(record, &ordinal);
  }
  const auto take_held = [&](std::int32_t before) {
    for (; more && record.id < before; more = records->next(record, &ordinal)) {
      if (options_.sessions.dropped.contains(record.map_id)) continue;
      if (database != nullptr) add_links_to_newcomers(*database, record);
      add(record, *held->nodes()->Get(ordinal));
    }
  };
  SignatureRecord fresh;
  for (const Newcomer* newcomer : content.newcomers) {
    take_held(newcomer->id);
    if (skipped_.contains(newcomer->id)) continue;
    if (!read_newcomer(*database, *newcomer, fresh, damages)) continue;
    add(fresh, node_at(fresh.id, newcomer->T_map_base));
  }
  take_held(std::numeric_limits<std::int32_t>::max());
  out_.packs[zone] = writer.finish(manifest_.payload_mask());
  folder.keep(out_.packs[zone].file);
}

}  // namespace zonepack::packer
