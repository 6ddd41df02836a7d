// SPDX-License-Identifier: Apache-2.0
#include "packer/update/map_update.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>

#include "packer/build/map_folder.hpp"
#include "packer/build/provenance.hpp"
#include "packer/sources/open_source.hpp"
#include "packer/update/held_plan.hpp"
#include "packer/update/newcomers.hpp"
#include "packer/update/next_manifest.hpp"
#include "packer/update/zone_packing.hpp"
#include "packer/zones/zone_file.hpp"
#include "runtime/pack_format/file/accounting.hpp"

namespace zonepack::packer {
namespace {

constexpr double kApart_m = 0.3;  // between two positions of one signature that are worth a word

class MapUpdate {
 public:
  MapUpdate(const UpdateOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        map_(options.map),
        manifest_(map_.manifest()),
        packed_(packing_of(manifest_)),
        held_(map_) {}

  UpdateSummary run() {
    require_writable_format();
    layers_ = merged_layers(layers_of(manifest_), options_.layers);
    zones_.emplace(map_, options_, packed_.snap_m, summary_);
    if (!options_.source.path.empty()) open_database();
    require_sessions();
    zones_->choose(held_, newcomers(), options_.orphans.value_or(packed_.orphans), summary_);
    MapFolder folder(options_.map);
    packed_zones_ = ZonePacking(map_, held_, *zones_, options_)
                        .pack(database_.get(), newcomers(), folder, damages_, progress_);
    finish(folder);
    return std::move(summary_);
  }

 private:
  void require_writable_format() const;
  void open_database();
  void require_kind() const;
  void require_sessions() const;
  void warn_of_other_frame();
  void warn_of_other_detector();
  ZonePlan with_layers() const;
  void finish(MapFolder& folder);
  const Newcomers* newcomers() const { return newcomers_ ? &*newcomers_ : nullptr; }

  const UpdateOptions& options_;
  Progress& progress_;
  MapReader map_;
  const fb::Manifest& manifest_;
  Packing packed_;
  HeldSignatures held_;
  std::vector<NamedLayer> layers_;
  std::optional<ZoneContents> zones_;
  std::optional<ZoneLookup> lookup_;  // of the next zones, for sources that cut at borders
  std::unique_ptr<MapSource> database_;
  std::optional<Newcomers> newcomers_;
  PackedZones packed_zones_;
  std::vector<Damage> damages_;
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

// Another kind has other features, poses and payloads, and a manifest names one kind.
void MapUpdate::require_kind() const {
  const std::string held = flatbuffers::GetString(manifest_.provenance()->source_kind());
  const std::string& kind = database_->outline().kind;
  if (kind != held) {
    throw std::runtime_error(options_.source.name() + ": is a source of kind " + kind +
                             ", and the map " + options_.map.string() + " was packed from kind " +
                             held + "; update it from one of that kind, or build another map");
  }
  const MapOutline& outline = database_->outline();
  const bool named = std::ranges::any_of(
      outline.nodes, [](const NodeOutline& node) { return !node.label.empty(); });
  if (!outline.numbered_anew || named || !options_.add || zones_->has_fresh()) return;
  throw std::runtime_error(
      options_.source.name() + ": is cut into tiles anew, so nothing says which of them the map " +
      options_.map.string() +
      " has already; name the zones to take from it with --replace ZONE, or add zones that the map "
      "lacks with --zones FILE --add");
}

void MapUpdate::open_database() {
  SourceOptions source = options_.source;
  lookup_.emplace(zones_->plan().zones);
  source.zone_at = [this](double x_m, double y_m, double z_m) {
    return lookup_->at({x_m, y_m}, z_m);
  };
  // Signatures of a metric map are aligned as newcomers; maps of keyframes come placed.
  const SourceKind* const kind = recognised_kind(source);
  if (kind != nullptr && aligns(kind->name)) source.placement.trajectory.clear();
  database_ = open_source(source);
  require_kind();
  newcomers_.emplace(*database_, held_, zones_->plan(), options_, layers_,
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
  refuse_damaged(damages_, options_.damaged, options_.source.name());
  summary_.signatures_shared = newcomers_->numbers().shared();
  summary_.not_chosen = newcomers_->not_chosen();
  summary_.unlinked_dropped = newcomers_->dropped();
  warn_of_other_frame();
  warn_of_other_detector();
}

void MapUpdate::warn_of_other_detector() {
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

// Zones whose layer was not drawn get that of most of their signatures.
ZonePlan MapUpdate::with_layers() const {
  ZonePlan plan = zones_->plan();
  if (layers_.empty()) return plan;
  std::set<std::string> names;
  for (const NamedLayer& layer : layers_of(manifest_)) names.insert(layer.name);
  for (std::uint32_t zone = 0; zone < plan.zones.size(); ++zone) {
    std::string& layer = plan.zones[zone].layer;
    const bool looked_at = zones_->contents()[zone].packed || !options_.layers.empty();
    const bool drawn =
        !layer.empty() && (zones_->is_fresh(plan.zones[zone].name) || !names.contains(layer));
    if (looked_at && !drawn) layer = most_common_layer(layers_, packed_zones_.sessions[zone]);
  }
  return plan;
}

void MapUpdate::finish(MapFolder& folder) {
  const ZonePlan plan = with_layers();
  summary_.version_before = to_hex(manifest_digest(map_.manifest_file()));
  ManifestContent next = next_content(manifest_, held_, *zones_, plan, packed_zones_,
                                      database_.get(), newcomers(), summary_);
  next.layers = layers_;
  Bytes manifest = manifest_bytes(next);
  summary_.unchanged = std::ranges::equal(ByteSpan(manifest), map_.manifest_file());
  if (!summary_.unchanged) {
    if (next.changes.size() == kMaxChanges) {
      throw std::runtime_error(options_.map.string() + ": was updated " +
                               std::to_string(kMaxChanges) +
                               " times, the most that a manifest lists; build the map again");
    }
    next.changes.push_back(change_since(map_, held_, *zones_, options_, summary_));
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
  for (const PackSummary& pack : packed_zones_.packs) summary_.pack_bytes += pack.bytes;
  summary_.damages = sorted(damages_);
}

}  // namespace

UpdateSummary update_map(const UpdateOptions& options, Progress& progress) {
  return MapUpdate(options, progress).run();
}

}  // namespace zonepack::packer
