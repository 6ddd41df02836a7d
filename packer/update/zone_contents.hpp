// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "packer/update/map_update.hpp"
#include "packer/update/newcomers.hpp"
#include "packer/zones/zone_plan.hpp"

namespace zonepack::packer {

// The zones of the next version of a map, and which signatures each is made of.
class ZoneContents {
 public:
  static constexpr std::uint32_t kNone = Partition::kNone;

  struct Content {
    std::uint32_t held = kNone;              // the zone of the map whose signatures it keeps
    std::vector<const Newcomer*> newcomers;  // by id
    bool packed = false;                     // else the pack stays as it is
    bool takes_newcomers = false;
  };

  // The zones of the map, with those of the zone file in their place or besides them. Warnings go
  // to `summary`. `options` outlives the object.
  ZoneContents(const MapReader& map, const UpdateOptions& options, double snap_m,
               UpdateSummary& summary);

  // Gives each newcomer to its zone, and packs zones anew that lose a session. Counts and warnings
  // go to `summary`. Throws std::runtime_error when a zone would lose all it has, or when the
  // policy refuses signatures in no zone. `newcomers` may be null, and outlives the object.
  void choose(const HeldSignatures& held, const Newcomers* newcomers, OrphanPolicy policy,
              UpdateSummary& summary);

  const ZonePlan& before() const noexcept { return before_; }  // the zones of the map
  const ZonePlan& plan() const noexcept { return plan_; }
  // By zone of the plan.
  const std::vector<Content>& contents() const noexcept { return contents_; }
  // Zones of the plan that the zone file drew.
  bool is_fresh(const std::string& name) const { return fresh_.contains(name); }
  bool has_fresh() const noexcept { return !fresh_.empty(); }
  // Where the plan has a zone of the map that keeps its signatures; else kNone.
  std::uint32_t place_of_held(std::uint32_t zone) const noexcept { return place_of_held_[zone]; }
  // Whether a newcomer of this id is packed.
  bool takes(std::int32_t id) const { return taken_.contains(id); }

 private:
  void give_newcomers(const HeldSignatures& held, const Newcomers& newcomers, OrphanPolicy policy,
                      UpdateSummary& summary);
  void refuse_orphans(const std::vector<const Newcomer*>& orphans) const;
  void refuse_empty() const;

  const UpdateOptions& options_;
  ZonePlan before_, plan_;
  std::vector<std::uint32_t> signatures_before_;  // by zone of the map
  std::set<std::string> fresh_;
  std::vector<Content> contents_;
  std::vector<std::uint32_t> place_of_held_;
  std::set<std::int32_t> taken_;
};

// The place of a zone in a plan, whose zones are sorted by name; ZoneContents::kNone: none.
std::uint32_t index_of(const ZonePlan& plan, const std::string& name);

}  // namespace zonepack::packer
