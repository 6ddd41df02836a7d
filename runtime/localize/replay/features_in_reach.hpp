// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/query/query_result.hpp"
#include "runtime/replay/resident_zones.hpp"

namespace zonepack::localize {

// The features of resident signatures that a robot at a prior could see, for one query after the
// other. What stays in reach is copied once; what is out of reach or no longer resident is
// forgotten.
//
// Memory: copies of the signatures in reach of the last prior.
class FeaturesInReach {
 public:
  explicit FeaturesInReach(std::uint32_t descriptor_bytes) : descriptor_bytes_(descriptor_bytes) {}

  // By zone, then by signature. Valid until the next call.
  std::span<const MapFeatures* const> in_reach_of(const QueryPrior& prior,
                                                  const ResidentZones& resident);

 private:
  using Key = std::tuple<ZoneId, std::uint32_t, std::uint32_t>;  // zone, generation, ordinal

  std::uint32_t descriptor_bytes_;
  std::map<Key, MapFeatures> copies_;
  std::vector<const MapFeatures*> chosen_;
};

}  // namespace zonepack::localize
