// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "packer/build/damages.hpp"
#include "packer/build/placing.hpp"
#include "packer/build/sessions.hpp"
#include "packer/encode/pack_writer.hpp"
#include "packer/record/source_kind.hpp"
#include "packer/zones/orphans.hpp"
#include "packer/zones/partition.hpp"
#include "packer/zones/split.hpp"
#include "packer/zones/zone_file.hpp"
#include "platform/process/progress.hpp"
#include "runtime/pack_format/file/accounting.hpp"

// Builds a map, a folder with one pack per zone and a manifest, from a database and a zone file.
namespace zonepack::packer {

struct BuildOptions {
  SourceOptions source;
  std::filesystem::path zones;
  std::filesystem::path out;
  PayloadMask payload = kEveryPayload;
  ByteCount max_zone_bytes = 0;  // charged for the default payload; 0: no limit
  OrphanPolicy orphans = OrphanPolicy::kNearest;
  double snap_m = kDefaultSnap_m;
  UnlinkedPolicy unlinked = UnlinkedPolicy::kOdometry;
  DamagedPolicy damaged = DamagedPolicy::kError;
  std::vector<NamedLayer> layers;  // sorted by name, as merged_layers() gives them
  SessionChoice sessions;
  unsigned jobs = 0;     // 0: one per core
  std::string detector;  // what found the features, where the source is wrong; empty: as it says
};

struct BuildSummary {
  std::string schema_version;
  std::size_t signatures = 0;  // packed
  std::uint64_t features = 0;
  std::size_t deleted = 0;  // weight -9
  std::map<std::int32_t, std::size_t> unlinked_by_session;
  std::map<std::int32_t, std::size_t> unconnected_by_session;  // of these, left out with kOdometry
  std::size_t unlinked_dropped = 0;
  std::map<std::int32_t, std::size_t> sessions;  // signatures of each, packed or not
  std::size_t not_chosen = 0;                    // signatures of sessions that are left out
  std::vector<Orphan> orphans;
  std::string orphans_text;  // near which zones they stand
  std::optional<Misdrawn> misdrawn;
  std::size_t orphans_dropped = 0;
  std::vector<Damage> damages;  // of the signatures that were skipped
  std::vector<SplitZone> split;
  std::vector<std::string> warnings;  // complete sentences
  std::vector<std::string> notes;     // how the source was read
  std::vector<std::string> zone_names;
  ZonePlan plan;                    // after splitting
  std::vector<PackSummary> packs;   // by zone
  ByteCount charged_bytes = 0;      // all zones, default payload: slots x slot size
  ByteCount stored_bytes = 0;       // features, scans, grids and core, as stored in packs
  ByteCount pack_bytes = 0;         // of all pack files
  ByteCount feature_row_bytes = 0;  // 72 bytes for each feature of the source
  ByteCount source_bytes = 0;       // feature rows and the zlib blobs of scans and grids
  SmallestBudget smallest;
  bool unchanged = false;  // the folder held the same manifest already
};

// Builds the map. The manifest's rename is the commit: until then, and after any failure, the map
// in `out` stays as it was. The same input and options give the same bytes for any number of jobs.
// Throws std::runtime_error with a complete message.
//
// Memory: the outline of the database and, per job, a few slots and one signature.
BuildSummary build_map(const BuildOptions& options, Progress& progress);

}  // namespace zonepack::packer
