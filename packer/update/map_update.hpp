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
#include "packer/record/source_kind.hpp"
#include "packer/zones/orphans.hpp"
#include "packer/zones/partition.hpp"
#include "platform/base/byte_count.hpp"
#include "platform/process/progress.hpp"

// Makes the next version of a map in its folder, of which most zones stay as they are.
namespace zonepack::packer {

struct UpdateOptions {
  std::filesystem::path map;
  SourceOptions source;         // without a path: none
  std::filesystem::path zones;  // empty: the zones of the map
  // Zones whose signatures are those of the database that stand in them; a name of a zone that was
  // split stands for all of its parts.
  std::vector<std::string> replace;
  // With `zones` that the map does not have: these, with the signatures that stand in them. Else
  // signatures that the map does not have, in the zones that it has.
  bool add = false;
  std::vector<NamedLayer> layers;          // in the place of the map's of the same names
  SessionChoice sessions;                  // numbered as in the map
  std::optional<OrphanPolicy> orphans;     // default: as the map was packed
  std::optional<UnlinkedPolicy> unlinked;  // the same
  DamagedPolicy damaged = DamagedPolicy::kError;
  unsigned jobs = 0;  // 0: one per core
};

struct UpdateSummary {
  std::string version_before, version;  // digests of the manifests, in hexadecimal
  bool unchanged = false;
  std::vector<std::string> zones_added, zones_removed, zones_changed;  // sorted
  std::size_t zones_kept = 0;
  std::size_t signatures_before = 0, signatures = 0;
  std::size_t signatures_added = 0;                 // ids that the map did not hold
  std::size_t signatures_removed = 0;               // ids that it no longer holds
  std::size_t signatures_shared = 0;                // of the database, that the map held already
  std::map<std::int32_t, std::int32_t> ids_mapped;  // of packed ones, by the database's id
  std::map<std::int32_t, std::int32_t> sessions_mapped;  // of these
  // Signatures of the database that the map lacks, in zones that stay as they are.
  std::map<std::string, std::size_t> left_out;
  std::size_t not_chosen = 0;        // of sessions that are left out
  std::size_t unlinked_dropped = 0;  // without a pose
  std::size_t links_to_kept = 0;     // links between zones that were packed and zones that stay
  std::size_t orphans = 0;           // given to the nearest zone, or dropped
  struct Fit {
    std::size_t pairs = 0;
    double rms_m = 0, largest_m = 0, scale = 1;
  };
  std::optional<Fit> alignment;
  std::vector<Damage> damages;        // of signatures that were skipped
  std::vector<std::string> warnings;  // complete sentences
  ByteCount written_bytes = 0;        // packs of zones added and changed
  ByteCount pack_bytes = 0;           // of all zones
  ByteCount smallest_budget_bytes = 0;
};

// The manifest's rename is the commit: until then, and after any failure, the map stays as it was.
// The same map, database and options give the same bytes for any number of jobs. Throws
// std::runtime_error with a complete message.
//
// Memory: the manifest, ids and links of all signatures, the outline of the database and, per job,
// a few slots, a window of the old pack and one signature.
UpdateSummary update_map(const UpdateOptions& options, Progress& progress);

}  // namespace zonepack::packer
