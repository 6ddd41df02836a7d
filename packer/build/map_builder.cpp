// SPDX-License-Identifier: Apache-2.0
#include "packer/build/map_builder.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "packer/build/manifest_writer.hpp"
#include "packer/build/map_folder.hpp"
#include "packer/build/repeated_features.hpp"
#include "packer/encode/packable.hpp"
#include "packer/sources/open_source.hpp"
#include "platform/base/file_kind.hpp"
#include "platform/base/require.hpp"

namespace zonepack::packer {
namespace {

PayloadSet payload_set(PayloadMask mask) {
  const auto has = [mask](fb::PayloadKind kind) { return (mask & mask_of(kind)) != 0; };
  return {has(fb::PayloadKind::Features), has(fb::PayloadKind::Scan),
          has(fb::PayloadKind::Grid),     has(fb::PayloadKind::Image),
          has(fb::PayloadKind::Depth),    has(fb::PayloadKind::UserData)};
}

fb::Node node_at(std::int32_t id, const Transform& T_map_base) {
  // Yaw is for people and pictures. The pose is a row-major 3x4 matrix: [0] is cos, [4] is sin.
  const float yaw = std::atan2(T_map_base[4], T_map_base[0]);
  return {T_map_base[3], T_map_base[7], T_map_base[11], yaw, id};
}

std::vector<Damage> sorted(std::vector<Damage> damages) {
  std::ranges::sort(damages, {}, [](const Damage& d) { return std::tie(d.signature, d.column); });
  return damages;
}

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
  void outline();
  void place();
  void pack(MapFolder& folder, const ZonePlan& plan, const std::vector<std::uint32_t>& zone_of);
  void pack_zone(MapSource& source, MapFolder& folder, std::size_t zone);
  void split(MapFolder& folder);
  void finish(MapFolder& folder);
  void refuse_damaged() const;
  ByteCount charged(std::size_t zone) const;
  std::vector<fb::ZoneEdge> edges() const;
  Digest16 lineage() const;

  const BuildOptions& options_;
  Progress& progress_;
  ZoneFile zones_;
  ZoneLookup lookup_;
  std::unique_ptr<MapSource> source_;
  BuildSummary summary_;

  std::vector<SignaturePlace> places_;  // of the signatures to pack, by id
  std::vector<fb::Node> nodes_;         // of the same signatures
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
  summary_.feature_row_bytes = outline.feature_bytes;
  summary_.source_bytes = summary_.feature_row_bytes + outline.scan_bytes + outline.grid_bytes;
  require_signatures(outline, options_.source.name());
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
  std::set<std::int32_t> placed_sessions;
  for (const NodeOutline& node : source_->outline().nodes) {
    if (node.pose) placed_sessions.insert(node.map_id);
  }
  const bool all = options_.unlinked == UnlinkedPolicy::kOdometryAll || placed_sessions.empty();
  for (const NodeOutline& node : source_->outline().nodes) {
    if (node.damaged) continue;
    const bool connected = all || placed_sessions.contains(node.map_id);
    const bool by_odometry = options_.unlinked == UnlinkedPolicy::kOdometry ||
                             options_.unlinked == UnlinkedPolicy::kOdometryAll;
    if (by_odometry && !connected) ++summary_.unconnected_by_session[node.map_id];
    const bool odometry = by_odometry && connected;
    const std::optional<Transform>& base = node.pose  ? node.pose
                                           : odometry ? node.odometry_pose
                                                      : node.pose;
    if (!base) {
      ++summary_.unlinked_dropped;
      continue;
    }
    const Transform& T = *base;
    places_.push_back({node.id, {T[3], T[7]}, T[11]});
    nodes_.push_back(node_at(node.id, T));
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

  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t jobs = std::clamp<std::size_t>(options_.jobs == 0 ? cores : options_.jobs, 1,
                                                   std::max<std::size_t>(order.size(), 1));
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      const std::unique_ptr<MapSource> source = source_->reopen();
      for (std::size_t i; (i = next++) < order.size();) pack_zone(*source, folder, order[i]);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure) failure = std::current_exception();
      next = order.size();
    }
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
  source_->require_unchanged();
  refuse_damaged();
  progress_.finish(std::to_string(total) + " signatures of " + std::to_string(order.size()) +
                   " zones on " + std::to_string(jobs) + (jobs == 1 ? " core" : " cores"));
}

void MapBuilder::pack_zone(MapSource& source, MapFolder& folder, std::size_t zone) {
  PackWriter writer(folder.path(), plan_.zones[zone].name);
  SignatureRecord record;
  const PayloadSet wanted = payload_set(options_.payload);
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
  packs_[zone] = writer.finish(options_.payload);
  folder.keep(packs_[zone].file);
}

void MapBuilder::refuse_damaged() const {
  if (damages_.empty() || options_.damaged == DamagedPolicy::kSkip) return;
  constexpr std::size_t kShown = 20;
  const std::vector<Damage> shown = sorted(damages_);
  std::string text = options_.source.name() + ": " + std::to_string(shown.size()) +
                     (shown.size() == 1 ? " signature" : " signatures") +
                     " damaged or beyond what a pack holds; repair the database, or leave them out "
                     "with --damaged skip";
  for (std::size_t i = 0; i < std::min(shown.size(), kShown); ++i) {
    // A row whose own id is wrong has no number to be named by.
    const std::string which =
        shown[i].signature == 0 ? "a signature" : "signature " + std::to_string(shown[i].signature);
    text += "\n  " + which + ", " + shown[i].column + ": " + shown[i].problem;
  }
  if (shown.size() > kShown) text += "\n  and " + std::to_string(shown.size() - kShown) + " more";
  throw std::runtime_error(text);
}

ByteCount MapBuilder::charged(std::size_t zone) const {
  return packs_[zone].slots[slot_table_index(
             payload_closure(kDefaultPayload, packs_[zone].grid_needs_scan), options_.payload)] *
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

std::vector<fb::ZoneEdge> MapBuilder::edges() const {
  std::map<std::int32_t, std::uint32_t> zone_by_id;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (zone_of_[i] != Partition::kNone) zone_by_id[places_[i].id] = zone_of_[i];
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts;
  for (std::uint32_t zone = 0; zone < links_.size(); ++zone) {
    for (const auto& [from, to] : links_[zone]) {
      const auto other = zone_by_id.find(to);
      if (other == zone_by_id.end() || other->second == zone) continue;
      ++counts[std::minmax(zone, other->second)];
    }
  }
  std::vector<fb::ZoneEdge> edges;
  edges.reserve(counts.size());
  for (const auto& [pair, links] : counts) edges.emplace_back(pair.first, pair.second, links);
  return edges;
}

// Every version of a map begins with the same first signature, so it names the lineage.
Digest16 MapBuilder::lineage() const {
  const NodeOutline& first = source_->outline().nodes.front();
  std::string text = source_->outline().kind + " " + std::to_string(first.id) + " ";
  text.append(reinterpret_cast<const char*>(&first.stamp), sizeof first.stamp);
  return blake2b_16(std::as_bytes(std::span(text)));
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
  ManifestContent content;
  content.plan = &plan_;
  content.packs = &packs_;
  for (const auto& members : members_) {
    std::vector<fb::Node>& nodes = content.nodes.emplace_back();
    for (const std::size_t member : members) {
      if (!skipped_.contains(places_[member].id)) nodes.push_back(nodes_[member]);
    }
  }
  content.edges = edges();
  content.lineage = lineage();
  content.payload = options_.payload;
  content.source_kind = source_->outline().kind;
  content.source_version = summary_.schema_version;
  static constexpr const char* kOrphans[] = {"nearest", "drop", "error"};
  static constexpr const char* kUnlinked[] = {"odometry", "drop", "error", "odometry-all"};
  content.options = std::string("orphans=") + kOrphans[static_cast<std::size_t>(options_.orphans)] +
                    " unlinked=" + kUnlinked[static_cast<std::size_t>(options_.unlinked)] +
                    " max_zone_bytes=" + std::to_string(options_.max_zone_bytes) +
                    " snap=" + number_text(options_.snap_m);
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
}

}  // namespace

BuildSummary build_map(const BuildOptions& options, Progress& progress) {
  return MapBuilder(options, progress).build();
}

}  // namespace zonepack::packer
