// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "packer/build/damages.hpp"
#include "packer/build/map_folder.hpp"
#include "packer/build/sessions.hpp"
#include "packer/update/zone_contents.hpp"

namespace zonepack::packer {

// The zones of the next version, packed. All lists are by zone of the plan.
struct PackedZones {
  std::vector<PackSummary> packs;
  std::vector<std::vector<fb::Node>> nodes;
  std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> links;  // of zones packed anew
  std::vector<SessionCounts> sessions;
};

// Packs the zones that changed, from signatures that the map holds and from newcomers, in order of
// id. What it refers to outlives it.
class ZonePacking {
 public:
  ZonePacking(const MapReader& map, const HeldSignatures& held, const ZoneContents& zones,
              const UpdateOptions& options)
      : map_(map), manifest_(map.manifest()), held_(held), zones_(zones), options_(options) {}

  // `database` and `newcomers` are null when the update takes nothing from a database. Signatures
  // that cannot be read or packed are added to `damages`; those that are there already are left
  // out. Throws std::runtime_error when the policy refuses damaged ones.
  PackedZones pack(MapSource* database, const Newcomers* newcomers, MapFolder& folder,
                   std::vector<Damage>& damages, Progress& progress);

 private:
  void keep(std::uint32_t zone);
  void pack_zone(MapSource* database, MapFolder& folder, std::uint32_t zone,
                 std::vector<Damage>& damages);
  bool read_newcomer(MapSource& database, const Newcomer& newcomer, SignatureRecord& into,
                     std::vector<Damage>& damages);
  void add_links_to_newcomers(MapSource& database, SignatureRecord& record) const;

  const MapReader& map_;
  const fb::Manifest& manifest_;
  const HeldSignatures& held_;
  const ZoneContents& zones_;
  const UpdateOptions& options_;
  const Newcomers* newcomers_ = nullptr;
  PackedZones out_;
  std::set<std::int32_t> skipped_;  // ids of newcomers that are damaged
  std::mutex mutex_;
};

}  // namespace zonepack::packer
