// SPDX-License-Identifier: Apache-2.0
#include "packer/update/map_update.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>

#include "packer/build/map_folder.hpp"
#include "packer/build/payload_set.hpp"
#include "packer/build/provenance.hpp"
#include "packer/build/zone_jobs.hpp"
#include "packer/decode/zone_records.hpp"
#include "packer/encode/packable.hpp"
#include "packer/record/link_order.hpp"
#include "packer/sources/open_source.hpp"
#include "packer/update/held_plan.hpp"
#include "packer/update/newcomers.hpp"
#include "packer/zones/redrawn.hpp"
#include "packer/zones/zone_file.hpp"
#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack::packer {
namespace {

constexpr double kApart_m = 0.3;  // between two positions of one signature that are worth a word

std::string named(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

// Zones of a plan are sorted by name.
std::uint32_t index_of(const ZonePlan& plan, const std::string& name) {
  const auto found = std::ranges::lower_bound(plan.zones, name, {}, &PlannedZone::name);
  if (found == plan.zones.end() || found->name != name) return Partition::kNone;
  return static_cast<std::uint32_t>(found - plan.zones.begin());
}

class MapUpdate {
 public:
  MapUpdate(const UpdateOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        map_(options.map),
        manifest_(map_.manifest()),
        packed_(packing_of(manifest_)),
        held_(map_),
        held_plan_(plan_of(manifest_)) {}

  UpdateSummary run() {
    require_writable_format();
    layers_ = merged_layers(layers_of(manifest_), options_.layers);
    draw();
    if (!options_.source.path.empty()) open_database();
    require_sessions();
    choose();
    MapFolder folder(options_.map);
    pack(folder);
    finish(folder);
    return std::move(summary_);
  }

 private:
  static constexpr std::uint32_t kNone = Partition::kNone;

  // What a zone of the next version is made of.
  struct Content {
    std::uint32_t held = kNone;              // the zone of the map whose signatures it keeps
    std::vector<const Newcomer*> newcomers;  // by id
    bool packed = false;                     // else the pack stays as it is
    bool takes_newcomers = false;
  };

  void require_writable_format() const;
  void draw();
  std::set<std::string> replaced_zones() const;
  void open_database();
  void require_kind() const;
  void require_sessions() const;
  void warn_of_other_frame();
  void choose();
  void choose_newcomers();
  void say_left_out();
  void refuse_orphans(const std::vector<const Newcomer*>& orphans) const;
  void refuse_empty() const;
  bool stays(const Newcomer& newcomer) const;
  void pack(MapFolder& folder);
  void add_links_to_newcomers(MapSource& database, SignatureRecord& record) const;
  void pack_zone(MapSource* database, MapFolder& folder, std::uint32_t zone);
  void name_layers();
  void compare();
  std::vector<fb::ZoneEdge> edges();
  ManifestContent content();
  void finish(MapFolder& folder);
  void count_signatures();

  const UpdateOptions& options_;
  Progress& progress_;
  MapReader map_;
  const fb::Manifest& manifest_;
  Packing packed_;
  HeldSignatures held_;
  ZonePlan held_plan_;
  std::vector<NamedLayer> layers_;

  ZonePlan plan_;
  std::set<std::string> fresh_;  // zones of the plan that the zone file drew
  std::set<std::string> replaced_;
  std::vector<Content> contents_;             // by zone of the plan
  std::vector<std::uint32_t> place_of_held_;  // by zone of the map: of the plan, if it is kept
  std::optional<ZoneLookup> lookup_;  // of the plan's zones, for sources that cut at borders
  std::unique_ptr<MapSource> database_;
  std::optional<Newcomers> newcomers_;
  std::set<std::int32_t> taken_;  // ids of newcomers that are packed

  std::vector<PackSummary> packs_;                                         // by zone
  std::vector<std::vector<fb::Node>> nodes_;                               // by zone
  std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> links_;  // by packed zone
  std::vector<SessionCounts> sessions_;                                    // by zone
  std::vector<Damage> damages_;
  std::set<std::int32_t> skipped_;
  std::mutex mutex_;
  UpdateSummary summary_;
};

void MapUpdate::require_writable_format() const {
  ManifestHeader header;
  std::memcpy(&header, map_.manifest_file().data(), sizeof header);
  if (header.minor <= kManifestMinor && (manifest_.payload_mask() & ~kEveryPayload) == 0) return;
  throw std::runtime_error(
      (options_.map / kManifestName).string() + ": is of format version " +
      std::to_string(header.major) + "." + std::to_string(header.minor) +
      ", of which this program would lose what it does not know; update it with the zonepack that "
      "wrote it, or build the map again");
}

// The zones that --replace names, parts of a split one each by itself.
std::set<std::string> MapUpdate::replaced_zones() const {
  std::set<std::string> names;
  for (const std::string& name : options_.replace) {
    for (const ZoneId zone : map_.zones_named(name)) {
      names.insert(manifest_.zones()->Get(zone)->name()->str());
    }
  }
  return names;
}

void MapUpdate::draw() {
  replaced_ = replaced_zones();
  if (options_.zones.empty()) {
    plan_ = held_plan_;
  } else {
    Redrawn redrawn = options_.add ? add_zones(held_plan_, options_.zones.string(), packed_.snap_m)
                                   : redraw(held_plan_, options_.zones.string(), packed_.snap_m,
                                            {options_.replace.begin(), options_.replace.end()});
    plan_ = std::move(redrawn.plan);
    fresh_ = std::move(redrawn.fresh);
    summary_.warnings = std::move(redrawn.warnings);
    for (const std::string& name : redrawn.not_taken) {
      summary_.warnings.push_back(options_.zones.string() + ": zone '" + name +
                                  "' is not in the map and not taken; add it with --add");
    }
  }
  contents_.resize(plan_.zones.size());
  place_of_held_.assign(held_plan_.zones.size(), kNone);
  for (std::uint32_t zone = 0; zone < plan_.zones.size(); ++zone) {
    const std::string& name = plan_.zones[zone].name;
    const std::uint32_t held = index_of(held_plan_, name);
    Content& content = contents_[zone];
    const bool replaced = replaced_.contains(name) || (!options_.add && fresh_.contains(name));
    if (held != kNone && !replaced) {
      content.held = held;
      place_of_held_[held] = zone;
    }
    content.takes_newcomers = options_.add ? fresh_.empty() || fresh_.contains(name) : replaced;
    content.packed = content.held == kNone;
  }
}

// Another kind has other features, poses and payloads, and a manifest names one kind.
void MapUpdate::require_kind() const {
  const std::string held = flatbuffers::GetString(manifest_.provenance()->source_kind());
  const std::string& kind = database_->outline().kind;
  if (kind == held) return;
  throw std::runtime_error(options_.source.name() + ": is a source of kind " + kind +
                           ", and the map " + options_.map.string() + " was packed from kind " +
                           held + "; update it from one of that kind, or build another map");
}

void MapUpdate::open_database() {
  SourceOptions source = options_.source;
  lookup_.emplace(plan_.zones);
  source.zone_at = [this](double x_m, double y_m, double z_m) {
    return lookup_->at({x_m, y_m}, z_m);
  };
  database_ = open_source(source);
  require_kind();
  newcomers_.emplace(*database_, held_, plan_, options_, layers_,
                     options_.unlinked.value_or(packed_.unlinked));
  for (const std::string& warning : database_->outline().warnings) {
    summary_.warnings.push_back(warning);
  }
  for (const std::string& warning : newcomers_->warnings()) summary_.warnings.push_back(warning);
  if (const auto& alignment = newcomers_->alignment()) {
    summary_.alignment = UpdateSummary::Fit{alignment->residuals_m.size(), alignment->rms_m,
                                            alignment->largest_m, alignment->scale_found};
  }
  damages_ = database_->outline().damages;
  for (const Damage& damage : damages_) skipped_.insert(newcomers_->numbers().id(damage.signature));
  refuse_damaged(damages_, options_.damaged, options_.source.name());
  summary_.signatures_shared = newcomers_->numbers().shared();
  summary_.not_chosen = newcomers_->not_chosen();
  summary_.unlinked_dropped = newcomers_->dropped();
  warn_of_other_frame();
  const std::string detector = database_->outline().detector;
  const std::string before = flatbuffers::GetString(manifest_.provenance()->detector());
  if (detector != before && !detector.empty() && !before.empty()) {
    summary_.warnings.push_back(
        options_.source.name() + ": its features were found with other settings (" + detector +
        ") than the map's (" + before +
        "); a localizer treats images by those of the map and may find little in the new zones");
  }
}

// Signatures that both hold, at different places, give away another frame.
void MapUpdate::warn_of_other_frame() {
  std::map<std::int32_t, Point3> before;
  for (const fb::Zone* zone : *manifest_.zones()) {
    if (zone->nodes() == nullptr) continue;
    for (const fb::Node* node : *zone->nodes())
      before[node->id()] = {node->x(), node->y(), node->z()};
  }
  double sum = 0;
  std::size_t count = 0;
  for (const Newcomer& newcomer : newcomers_->all()) {
    const auto there = before.find(newcomer.id);
    if (!newcomer.held || there == before.end()) continue;
    const Transform& T = newcomer.T_map_base;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = static_cast<double>(T[4 * k + 3]) - there->second[k];
      sum += off * off;
    }
    ++count;
  }
  const double rms = count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
  if (rms <= kApart_m) return;
  summary_.warnings.push_back(
      options_.source.name() + ": the " + std::to_string(count) +
      " signatures that the map holds too stand " + number_text(rms) +
      " m (rms) from where the map has them; is it in another frame? Give --align a trajectory of "
      "its signatures in the map's frame, or build the whole map again");
}

void MapUpdate::require_sessions() const {
  SessionCounts sessions = held_.sessions();
  if (newcomers_) {
    for (const NodeOutline& node : database_->outline().nodes) {
      ++sessions[newcomers_->numbers().session(node.map_id)];
    }
  }
  require_known(options_.sessions, layers_, sessions, options_.map.string());
}

void MapUpdate::choose() {
  for (const auto& [id, signature] : held_.by_id()) {
    const std::uint32_t zone = place_of_held_[signature.zone];
    if (zone == kNone || !options_.sessions.dropped.contains(signature.session)) continue;
    contents_[zone].packed = true;
  }
  if (newcomers_) choose_newcomers();
  say_left_out();
}

// Whether the map holds this very signature, in a zone that keeps it.
bool MapUpdate::stays(const Newcomer& newcomer) const {
  if (!newcomer.held) return false;
  return place_of_held_[held_.find(newcomer.id)->zone] != kNone;
}

void MapUpdate::choose_newcomers() {
  const OrphanPolicy policy = options_.orphans.value_or(packed_.orphans);
  std::vector<const Newcomer*> orphans;
  for (const Newcomer& newcomer : newcomers_->all()) {
    if (stays(newcomer)) continue;
    Content& content = contents_[newcomer.zone];
    if (!content.takes_newcomers) {
      ++summary_.left_out[plan_.zones[newcomer.zone].name];
      continue;
    }
    if (newcomer.orphan) {
      orphans.push_back(&newcomer);
      if (policy == OrphanPolicy::kDrop) continue;
    }
    content.newcomers.push_back(&newcomer);
    content.packed = true;
    taken_.insert(newcomer.id);
  }
  summary_.orphans = orphans.size();
  if (policy == OrphanPolicy::kError && !orphans.empty()) refuse_orphans(orphans);
  refuse_empty();
}

void MapUpdate::refuse_orphans(const std::vector<const Newcomer*>& orphans) const {
  const Newcomer& first = *orphans.front();
  throw std::runtime_error(
      options_.source.name() + ": " + std::to_string(orphans.size()) +
      (orphans.size() == 1 ? " signature stands" : " signatures stand") +
      " in no zone, nearest to a zone of this update, such as " + std::to_string(first.node->id) +
      " at " + point_text({first.T_map_base[3], first.T_map_base[7]}) +
      "; draw the zones so that they hold them, or update with --orphans nearest or drop");
}

// A zone that would lose all that it has is more often a wrong frame than a wish.
void MapUpdate::refuse_empty() const {
  for (std::uint32_t zone = 0; zone < contents_.size(); ++zone) {
    const std::string& name = plan_.zones[zone].name;
    const bool replaced = contents_[zone].takes_newcomers && !options_.add;
    if (!replaced || !contents_[zone].newcomers.empty()) continue;
    const std::uint32_t before = index_of(held_plan_, name);
    if (before != kNone && manifest_.zones()->Get(before)->signatures() == 0) continue;
    throw std::runtime_error(options_.source.name() + ": no signature stands in zone " + name +
                             ", which would lose all it has; is the database in the map's frame? "
                             "If not, give --align a trajectory of its signatures there");
  }
}

void MapUpdate::say_left_out() {
  if (summary_.left_out.empty()) return;
  std::size_t count = 0;
  std::string zones;
  constexpr std::size_t kShown = 8;
  std::size_t shown = 0;
  for (const auto& [zone, signatures] : summary_.left_out) {
    count += signatures;
    if (shown++ < kShown) {
      zones += (zones.empty() ? "" : ", ") + zone + ": " + std::to_string(signatures);
    }
  }
  if (shown > kShown) zones += " and " + std::to_string(shown - kShown) + " zones more";
  summary_.warnings.push_back(
      options_.source.name() + ": " + std::to_string(count) +
      (count == 1 ? " signature that the map lacks stands"
                  : " signatures that the map lacks stand") +
      " in zones that stay as they are (" + zones + "); left out. Take them with --replace ZONE" +
      (options_.zones.empty() && options_.add ? "" : ", or all with --add and no --zones"));
}

void MapUpdate::pack(MapFolder& folder) {
  packs_.resize(contents_.size());
  nodes_.resize(contents_.size());
  links_.resize(contents_.size());
  sessions_.resize(contents_.size());
  std::vector<std::uint32_t> order;
  for (std::uint32_t zone = 0; zone < contents_.size(); ++zone) {
    if (contents_[zone].packed) {
      order.push_back(zone);
      continue;
    }
    const fb::Zone& held = *manifest_.zones()->Get(contents_[zone].held);
    packs_[zone] = pack_of(held);
    if (held.nodes() != nullptr) {
      for (const fb::Node* node : *held.nodes()) nodes_[zone].push_back(*node);
    }
  }
  for (const auto& [id, signature] : held_.by_id()) {
    const std::uint32_t zone = place_of_held_[signature.zone];
    if (zone != kNone && !contents_[zone].packed) ++sessions_[zone][signature.session];
  }
  progress_.start("packing", order.size(), "zones");
  run_zone_jobs(order.size(), options_.jobs, database_.get(),
                [&](MapSource* database, std::size_t i) {
                  pack_zone(database, folder, order[i]);
                  progress_.advance();
                });
  if (database_) database_->require_unchanged();
  refuse_damaged(damages_, options_.damaged, options_.source.name());
  progress_.finish(std::to_string(order.size()) + (order.size() == 1 ? " zone" : " zones"));
}

// A signature that the map keeps may have been linked to new ones since.
void MapUpdate::add_links_to_newcomers(MapSource& database, SignatureRecord& record) const {
  const std::optional<std::int32_t> id = newcomers_->numbers().in_database(record.id);
  if (!id || database.outline().find(*id)->damaged) return;
  constexpr PayloadSet kNothing{false, false, false, false, false, false};
  SignatureRecord now = database.read(*id, kNothing);
  newcomers_->numbers().apply(now);
  for (Link& link : now.links) {
    const bool known = std::ranges::any_of(record.links, [&](const Link& held) {
      return held.to == link.to && held.type == link.type;
    });
    if (!known && taken_.contains(link.to)) record.links.push_back(std::move(link));
  }
  sort_links(record.links);
}

void MapUpdate::pack_zone(MapSource* database, MapFolder& folder, std::uint32_t zone) {
  const Content& content = contents_[zone];
  PackWriter writer(folder.path(), plan_.zones[zone].name, pack_minor(manifest_.payload_mask()));
  std::optional<ZoneRecords> records;
  const fb::Zone* held = nullptr;
  SignatureRecord record;
  std::uint32_t ordinal = 0;
  bool more = false;
  if (content.held != kNone) {
    held = manifest_.zones()->Get(content.held);
    records.emplace(map_, *held);
    more = records->next(record, &ordinal);
  }
  SessionCounts& sessions = sessions_[zone];
  const auto take_held = [&](std::int32_t before) {
    for (; more && record.id < before; more = records->next(record, &ordinal)) {
      if (options_.sessions.dropped.contains(record.map_id)) continue;
      if (database != nullptr) add_links_to_newcomers(*database, record);
      const fb::Node& node = *held->nodes()->Get(ordinal);
      ++sessions[record.map_id];
      for (const Link& link : record.links) links_[zone].emplace_back(record.id, link.to);
      nodes_[zone].push_back(node);
      writer.add(record, node.x(), node.y());
    }
  };
  SignatureRecord fresh;
  const PayloadSet wanted = payload_set(manifest_.payload_mask());
  for (const Newcomer* newcomer : content.newcomers) {
    take_held(newcomer->id);
    if (skipped_.contains(newcomer->id)) continue;
    const std::int32_t source_id = newcomer->node->id;
    try {
      database->read(source_id, wanted, fresh);
    } catch (const DamagedSignature& damaged) {
      const std::lock_guard lock(mutex_);
      damages_.push_back(damaged.damage());
      continue;
    }
    if (const auto unpackable = find_unpackable(fresh)) {
      const std::lock_guard lock(mutex_);
      damages_.push_back({source_id, unpackable->column, unpackable->problem});
      continue;
    }
    newcomers_->numbers().apply(fresh);
    const Transform& T = newcomer->T_map_base;
    if (fresh.pose) fresh.pose = T;
    ++sessions[fresh.map_id];
    for (const Link& link : fresh.links) links_[zone].emplace_back(fresh.id, link.to);
    nodes_[zone].push_back(node_at(fresh.id, T));
    writer.add(fresh, T[3], T[7]);
  }
  take_held(std::numeric_limits<std::int32_t>::max());
  packs_[zone] = writer.finish(manifest_.payload_mask());
  folder.keep(packs_[zone].file);
}

// Zones whose layer was not drawn get that of most of their signatures.
void MapUpdate::name_layers() {
  if (layers_.empty()) return;
  std::set<std::string> names;
  for (const NamedLayer& layer : layers_of(manifest_)) names.insert(layer.name);
  for (std::uint32_t zone = 0; zone < plan_.zones.size(); ++zone) {
    std::string& layer = plan_.zones[zone].layer;
    const bool looked_at = contents_[zone].packed || !options_.layers.empty();
    const bool drawn =
        !layer.empty() && (fresh_.contains(plan_.zones[zone].name) || !names.contains(layer));
    if (looked_at && !drawn) layer = most_common_layer(layers_, sessions_[zone]);
  }
}

std::vector<fb::ZoneEdge> MapUpdate::edges() {
  std::map<std::int32_t, std::uint32_t> zone_of;
  for (std::uint32_t zone = 0; zone < nodes_.size(); ++zone) {
    for (const fb::Node& node : nodes_[zone]) zone_of[node.id()] = zone;
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> counts;
  const auto count = [&](std::int32_t from, std::int32_t to) {
    const std::uint32_t zone = zone_of.at(from);
    const auto other = zone_of.find(to);
    if (other == zone_of.end() || other->second == zone) return;
    ++counts[std::minmax(zone, other->second)];
    summary_.links_to_kept += contents_[zone].packed != contents_[other->second].packed;
  };
  for (const auto& zone : links_) {
    for (const auto& [from, to] : zone) count(from, to);
  }
  for (const auto& [id, signature] : held_.by_id()) {
    const auto zone = zone_of.find(id);
    if (zone == zone_of.end() || contents_[zone->second].packed) continue;
    for (const std::int32_t to : signature.links) count(id, to);
  }
  std::vector<fb::ZoneEdge> edges;
  edges.reserve(counts.size());
  for (const auto& [pair, links] : counts) edges.emplace_back(pair.first, pair.second, links);
  return edges;
}

// Which zones are others than before.
void MapUpdate::compare() {
  std::set<std::string> now;
  for (std::uint32_t zone = 0; zone < plan_.zones.size(); ++zone) {
    const std::string& name = plan_.zones[zone].name;
    now.insert(name);
    const std::uint32_t held = index_of(held_plan_, name);
    if (held == kNone) {
      summary_.zones_added.push_back(name);
    } else {
      const fb::Zone& before = *manifest_.zones()->Get(held);
      if (pack_of(before).digest == packs_[zone].digest) {
        ++summary_.zones_kept;
        continue;
      }
      summary_.zones_changed.push_back(name);
    }
    summary_.written_bytes += packs_[zone].bytes;
  }
  for (const PlannedZone& zone : held_plan_.zones) {
    if (!now.contains(zone.name)) summary_.zones_removed.push_back(zone.name);
  }
}

void MapUpdate::count_signatures() {
  summary_.signatures_before = held_.by_id().size();
  std::set<std::int32_t> now;
  for (const auto& zone : nodes_) {
    for (const fb::Node& node : zone) now.insert(node.id());
  }
  summary_.signatures = now.size();
  for (const std::int32_t id : now) summary_.signatures_added += held_.find(id) == nullptr;
  for (const auto& [id, signature] : held_.by_id()) {
    summary_.signatures_removed += !now.contains(id);
  }
  if (!newcomers_) return;
  for (const auto& [from, to] : newcomers_->numbers().ids()) {
    if (now.contains(to)) summary_.ids_mapped[from] = to;
  }
  for (const Newcomer& newcomer : newcomers_->all()) {
    const std::int32_t before = newcomer.node->map_id;
    if (before != newcomer.session && now.contains(newcomer.id)) {
      summary_.sessions_mapped[before] = newcomer.session;
    }
  }
}

ManifestContent MapUpdate::content() {
  const fb::Provenance& before = *manifest_.provenance();
  ManifestContent content;
  content.plan = &plan_;
  content.packs = &packs_;
  content.nodes = nodes_;
  content.edges = edges();
  std::copy(manifest_.lineage()->begin(), manifest_.lineage()->end(), content.lineage.begin());
  content.payload = manifest_.payload_mask();
  content.source_kind = flatbuffers::GetString(before.source_kind());
  content.source_version = flatbuffers::GetString(before.source_version());
  content.options = flatbuffers::GetString(before.options());
  content.detector = flatbuffers::GetString(before.detector());
  content.source_feature_count = before.source_feature_count();
  content.source_bytes = before.source_bytes();
  content.layers = layers_;
  content.changes = changes_of(manifest_);
  const bool packs_changed = !summary_.zones_added.empty() || !summary_.zones_changed.empty();
  if (!database_ || !packs_changed) return content;
  const MapOutline& outline = database_->outline();
  const SourceBytes source = source_bytes(outline);
  std::uint64_t features = 0;
  for (const PackSummary& pack : packs_) features += pack.features;
  // A database that was grown on holds what the map was packed from.
  if (newcomers_->numbers().grown() && source.features >= features) {
    content.source_version = outline.schema_version;
    content.source_feature_count = source.features;
    content.source_bytes = source.bytes;
  } else {
    content.source_feature_count += source.features;
    content.source_bytes += source.bytes;
  }
  return content;
}

void MapUpdate::finish(MapFolder& folder) {
  name_layers();
  compare();
  count_signatures();
  summary_.version_before = to_hex(manifest_digest(map_.manifest_file()));
  ManifestContent next = content();
  Bytes manifest = manifest_bytes(next);
  summary_.unchanged = std::ranges::equal(ByteSpan(manifest), map_.manifest_file());
  if (!summary_.unchanged) {
    VersionChange change;
    change.parent = manifest_digest(map_.manifest_file());
    if (!options_.replace.empty()) change.what = "replace " + named(options_.replace);
    if (options_.add) change.what = "add";
    for (const std::int32_t session : options_.sessions.dropped) {
      change.what +=
          (change.what.empty() ? "" : "; ") + ("drop-session " + std::to_string(session));
    }
    for (const NamedLayer& layer : options_.layers) {
      change.what +=
          (change.what.empty() ? "" : "; ") + ("layer " + layer.name + "=" + sessions_text(layer));
    }
    change.zones = manifest_.zones()->size();
    change.signatures = held_.by_id().size();
    for (const fb::Zone* zone : *manifest_.zones()) change.pack_bytes += zone->pack_bytes();
    change.added = summary_.zones_added;
    change.removed = summary_.zones_removed;
    change.changed = summary_.zones_changed;
    if (next.changes.size() == kMaxChanges) {
      throw std::runtime_error(options_.map.string() + ": was updated " +
                               std::to_string(kMaxChanges) +
                               " times, the most that a manifest lists; build the map again");
    }
    next.changes.push_back(std::move(change));
    manifest = manifest_bytes(next);
    if (manifest_.signature() != nullptr) {
      summary_.warnings.push_back(options_.map.string() +
                                  ": the map was signed, its new version is not; sign it again");
    }
    folder.commit(manifest);
  }
  summary_.version = to_hex(manifest_digest(manifest));
  const fb::Manifest& checked = **check_manifest(manifest);
  summary_.smallest_budget_bytes =
      smallest_budget(map_costs(checked, manifest.size(), kDefaultPayload), {}).bytes;
  for (const PackSummary& pack : packs_) summary_.pack_bytes += pack.bytes;
  summary_.damages = sorted(damages_);
}

}  // namespace

UpdateSummary update_map(const UpdateOptions& options, Progress& progress) {
  return MapUpdate(options, progress).run();
}

}  // namespace zonepack::packer
