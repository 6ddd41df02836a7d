// SPDX-License-Identifier: Apache-2.0
#include "packer/build/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>

#include "packer/build/damages.hpp"
#include "packer/build/manifest_writer.hpp"
#include "packer/build/map_folder.hpp"
#include "packer/build/payload_set.hpp"
#include "packer/build/placing.hpp"
#include "packer/build/provenance.hpp"
#include "packer/build/repeated_features.hpp"
#include "packer/build/zone_edges.hpp"
#include "packer/build/zone_jobs.hpp"
#include "packer/encode/packable.hpp"
#include "packer/sources/open_source.hpp"
#include "platform/base/require.hpp"
#include "platform/base/shell_word.hpp"

namespace zonepack::packer {
namespace {

class MapBuilder {
 public:
  MapBuilder(const BuildOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        zones_(load_zone_file(options.zones.string(), options.snap_m)),
        lookup_(zones_.plan.zones),
        source_(open_source(with_zones(options.source))) {}

  BuildSummary build() {
    outline();
    place();
    MapFolder folder(options_.out);
    pack(folder, plan_, zone_of_);
    if (options_.max_zone_bytes > 0) split(folder);
    finish(folder);
    return std::move(summary_);
  }

 private:
  SourceOptions with_zones(SourceOptions source) const;
  PayloadMask packed_payload() const;
  void outline();
  void place();
  void pack(MapFolder& folder, const ZonePlan& plan, const std::vector<std::uint32_t>& zone_of);
  void pack_zone(MapSource& source, MapFolder& folder, std::size_t zone);
  void split(MapFolder& folder);
  void name_layers();
  void finish(MapFolder& folder);
  ByteCount charged(std::size_t zone) const;
  Digest16 lineage() const;

  const BuildOptions& options_;
  Progress& progress_;
  ZoneFile zones_;
  ZoneLookup lookup_;
  std::unique_ptr<MapSource> source_;
  const PayloadMask payload_ = packed_payload();
  BuildSummary summary_;

  std::vector<SignaturePlace> places_;  // of the signatures to pack, by id
  std::vector<fb::Node> nodes_;         // of the same signatures
  std::vector<std::int32_t> sessions_;  // of the same signatures
  ZonePlan plan_;
  std::vector<std::uint32_t> zone_of_;
  std::vector<std::vector<std::size_t>> members_;  // by zone: indices into places_
  std::vector<PackSummary> packs_;
  std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> links_;  // by zone: from, to
  std::set<std::int32_t> skipped_;                                         // damaged
  std::vector<Damage> damages_;
  RepeatedFeatures repeated_;
  std::mutex mutex_;
};

SourceOptions MapBuilder::with_zones(SourceOptions source) const {
  source.zone_at = [this](double x_m, double y_m, double z_m) {
    return lookup_.at({x_m, y_m}, z_m);
  };
  return source;
}

// Of the kinds asked for, those that such a source may have: maps of other kinds keep their bytes
// when a kind of payload is added.
PayloadMask MapBuilder::packed_payload() const {
  constexpr PayloadMask kBlocks = mask_of(fb::PayloadKind::Blocks);
  return options_.payload & (source_->outline().is_blocks ? kCoreOnly | kBlocks : ~kBlocks);
}

void MapBuilder::outline() {
  const MapOutline& outline = source_->outline();
  summary_.schema_version = outline.schema_version;
  summary_.deleted = outline.deleted_nodes;
  summary_.unlinked_by_session = outline.unlinked_by_session;
  summary_.warnings = outline.warnings;
  summary_.notes = outline.notes;
  for (const Finding& finding : zones_.findings.warnings) {
    summary_.warnings.push_back(to_string(finding, options_.zones.string()));
  }
  const SourceBytes source = source_bytes(outline);
  summary_.feature_row_bytes = source.feature_rows;
  summary_.source_bytes = source.bytes;
  require_signatures(outline, options_.source.name());
  for (const NodeOutline& node : outline.nodes) ++summary_.sessions[node.map_id];
  require_known(options_.sessions, options_.layers, summary_.sessions, options_.source.name());
  damages_ = outline.damages;
  for (const Damage& damage : damages_) skipped_.insert(damage.signature);
  if (options_.unlinked == UnlinkedPolicy::kError && outline.unlinked() > 0) {
    throw std::runtime_error(
        options_.source.name() + ": " + std::to_string(outline.unlinked()) +
        (outline.unlinked() == 1 ? " signature has" : " signatures have") +
        " no optimised pose; open the database with RTAB-Map and close it cleanly, "
        "or pack with --unlinked odometry or drop");
  }
}

void MapBuilder::place() {
  const Placing placing = place_signatures(source_->outline(), options_.unlinked);
  summary_.unconnected_by_session = placing.unconnected_by_session;
  summary_.unlinked_dropped = placing.dropped;
  for (const auto& [node, T] : placing.placed) {
    if (!options_.sessions.takes(options_.layers, node->map_id)) {
      ++summary_.not_chosen;
      continue;
    }
    places_.push_back({node->id, {T[3], T[7]}, T[11]});
    nodes_.push_back(node_at(node->id, T));
    sessions_.push_back(node->map_id);
  }
  if (places_.empty() && summary_.not_chosen > 0) {
    throw std::runtime_error(options_.source.name() +
                             ": no signature is left; --layers and --drop-session leave out all " +
                             std::to_string(summary_.not_chosen));
  }
  for (const auto& [session, count] : summary_.unconnected_by_session) {
    summary_.warnings.push_back(
        options_.source.name() + ": session " + std::to_string(session) + " with its " +
        std::to_string(count) + (count == 1 ? " signature" : " signatures") +
        " is connected to no other, so nothing says where it is; it is left out. Keep it with "
        "--unlinked odometry-all");
  }
  Partition partition = packer::partition(zones_.plan.zones, places_, options_.orphans);
  summary_.orphans = partition.orphans;
  const std::vector<OrphanGroup> groups = group_orphans(partition.orphans);
  if (!groups.empty()) summary_.orphans_text = groups_text(groups, zones_.plan.zones);
  summary_.misdrawn = find_misdrawn(zones_.plan.zones, places_, partition.orphans.size());
  if (options_.orphans == OrphanPolicy::kDrop) {
    summary_.orphans_dropped = partition.orphans.size();
  }
  plan_ = zones_.plan;
  zone_of_ = std::move(partition.zone_of);
}

void MapBuilder::pack(MapFolder& folder, const ZonePlan& plan,
                      const std::vector<std::uint32_t>& zone_of) {
  members_.assign(plan.zones.size(), {});
  for (std::size_t i = 0; i < zone_of.size(); ++i) {
    if (zone_of[i] != Partition::kNone) members_[zone_of[i]].push_back(i);
  }
  packs_.assign(plan.zones.size(), {});
  links_.assign(plan.zones.size(), {});
  repeated_.clear();
  std::vector<std::size_t> order(plan.zones.size());  // largest first, for an even load
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    return members_[a].size() > members_[b].size();
  });
  std::size_t total = 0;
  for (const auto& members : members_) total += members.size();
  progress_.start("packing", total, "signatures");

  const std::size_t jobs = run_zone_jobs(
      order.size(), options_.jobs, source_.get(),
      [&](MapSource* source, std::size_t i) { pack_zone(*source, folder, order[i]); });
  source_->require_unchanged();
  refuse_damaged(damages_, options_.damaged, options_.source.name());
  progress_.finish(std::to_string(total) + " signatures of " + std::to_string(order.size()) +
                   " zones on " + std::to_string(jobs) + (jobs == 1 ? " core" : " cores"));
}

void MapBuilder::pack_zone(MapSource& source, MapFolder& folder, std::size_t zone) {
  PackWriter writer(folder.path(), plan_.zones[zone].name, pack_minor(payload_));
  SignatureRecord record;
  const PayloadSet wanted = payload_set(payload_);
  for (const std::size_t member : members_[zone]) {
    const SignaturePlace& place = places_[member];
    progress_.advance();
    try {
      source.read(place.id, wanted, record);
    } catch (const DamagedSignature& damaged) {
      const std::lock_guard lock(mutex_);
      if (skipped_.insert(place.id).second) damages_.push_back(damaged.damage());
      continue;
    }
    if (const auto unpackable = find_unpackable(record)) {
      const std::lock_guard lock(mutex_);
      if (skipped_.insert(place.id).second) {
        damages_.push_back({place.id, unpackable->column, unpackable->problem});
      }
      continue;
    }
    repeated_.add(record);
    for (const Link& link : record.links) links_[zone].emplace_back(record.id, link.to);
    writer.add(record, static_cast<float>(place.p_map.x_m), static_cast<float>(place.p_map.y_m));
  }
  packs_[zone] = writer.finish(payload_);
  folder.keep(packs_[zone].file);
}

ByteCount MapBuilder::charged(std::size_t zone) const {
  return packs_[zone].slots[slot_table_index(
             payload_closure(kDefaultPayload, packs_[zone].grid_needs_scan), payload_)] *
         kSlotBytes;
}

// Weights are shares of decoded bytes. Only packing the parts shows how much the slots round up, so
// this packs again with a lower limit for as long as a part comes out too large.
void MapBuilder::split(MapFolder& folder) {
  const auto largest = [this] {
    ByteCount most = 0;
    for (std::size_t i = 0; i < packs_.size(); ++i) most = std::max(most, charged(i));
    return most;
  };
  if (largest() <= options_.max_zone_bytes) return;
  std::vector<ByteCount> weights(places_.size());
  for (std::size_t zone = 0; zone < members_.size(); ++zone) {
    std::size_t ordinal = 0;
    for (const std::size_t member : members_[zone]) {
      if (skipped_.contains(places_[member].id)) continue;
      weights[member] = packs_[zone].signature_bytes[ordinal++];
    }
  }
  const ZonePlan whole = plan_;
  const std::vector<std::uint32_t> whole_zone_of = zone_of_;
  ByteCount limit = options_.max_zone_bytes;
  while (largest() > options_.max_zone_bytes) {
    SplitPlan split;
    try {
      split = split_oversized(whole, places_, whole_zone_of, weights, limit);
    } catch (const std::runtime_error& error) {
      if (limit == options_.max_zone_bytes) throw;
      throw std::runtime_error(std::string(error.what()) + "; slots of " +
                               format_byte_count(kSlotBytes) + " round up, so give " +
                               format_byte_count(options_.max_zone_bytes - limit) +
                               " more than that");
    }
    plan_ = std::move(split.plan);
    zone_of_ = std::move(split.zone_of);
    summary_.split = std::move(split.split);
    pack(folder, plan_, zone_of_);
    limit -= std::min(limit, kSlotBytes);
  }
}

// Every version of a map begins with the same first signature, so it names the lineage.
Digest16 MapBuilder::lineage() const {
  const NodeOutline& first = source_->outline().nodes.front();
  std::string text = source_->outline().kind + " " + std::to_string(first.id) + " ";
  text.append(reinterpret_cast<const char*>(&first.stamp), sizeof first.stamp);
  return blake2b_16(std::as_bytes(std::span(text)));
}

// A zone without a layer of its own gets that of most of its signatures.
void MapBuilder::name_layers() {
  for (std::size_t zone = 0; zone < plan_.zones.size(); ++zone) {
    if (!plan_.zones[zone].layer.empty()) continue;
    SessionCounts counts;
    for (const std::size_t member : members_[zone]) {
      if (!skipped_.contains(places_[member].id)) ++counts[sessions_[member]];
    }
    plan_.zones[zone].layer = most_common_layer(options_.layers, counts);
  }
}

void MapBuilder::finish(MapFolder& folder) {
  // In a whole database a robot that stands still in a simulation may see the same image twice.
  if (const auto repeated = repeated_.text(); repeated && !damages_.empty()) {
    summary_.warnings.push_back(
        options_.source.name() + ": " + *repeated +
        ": in a damaged database one page may stand in the place of another, and then at most one "
        "of them is right; check the file with: sqlite3 " +
        shell_quoted(options_.source.name()) + " 'PRAGMA integrity_check'");
  }
  if (!options_.layers.empty()) name_layers();
  ManifestContent content;
  content.layers = options_.layers;
  content.plan = &plan_;
  content.packs = &packs_;
  for (const auto& members : members_) {
    std::vector<fb::Node>& nodes = content.nodes.emplace_back();
    for (const std::size_t member : members) {
      if (!skipped_.contains(places_[member].id)) nodes.push_back(nodes_[member]);
    }
  }
  ZoneEdges edges(content.nodes);
  for (const auto& zone : links_) {
    for (const auto& [from, to] : zone) edges.add(from, to);
  }
  content.edges = edges.list();
  content.lineage = lineage();
  content.payload = payload_;
  content.source_kind = source_->outline().kind;
  content.source_version = summary_.schema_version;
  content.options = packing_text({.orphans = options_.orphans,
                                  .unlinked = options_.unlinked,
                                  .max_zone_bytes = options_.max_zone_bytes,
                                  .snap_m = options_.snap_m,
                                  .sessions = options_.sessions});
  content.detector = options_.detector.empty() ? source_->outline().detector : options_.detector;
  content.source_feature_count = source_->outline().feature_count;
  content.source_bytes = summary_.source_bytes;
  const Bytes manifest = manifest_bytes(content);
  summary_.unchanged = folder.commit(manifest);

  const fb::Manifest& checked = **check_manifest(manifest);
  summary_.smallest = smallest_budget(map_costs(checked, manifest.size(), kDefaultPayload), {});
  for (std::size_t i = 0; i < packs_.size(); ++i) {
    const PackSummary& pack = packs_[i];
    summary_.signatures += pack.signatures;
    summary_.features += pack.features;
    summary_.charged_bytes += charged(i);
    summary_.pack_bytes += pack.bytes;
    for (std::size_t k = 0; k < kPayloadKinds; ++k) {
      if ((kDefaultPayload >> k & 1) != 0) summary_.stored_bytes += pack.payloads[k].stored;
    }
    summary_.zone_names.push_back(plan_.zones[i].name);
  }
  summary_.damages = sorted(damages_);
  summary_.packs = std::move(packs_);
  summary_.plan = std::move(plan_);
}

}  // namespace

BuildSummary build_map(const BuildOptions& options, Progress& progress) {
  return MapBuilder(options, progress).build();
}

}  // namespace zonepack::packer
