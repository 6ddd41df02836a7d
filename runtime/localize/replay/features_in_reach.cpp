// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/features_in_reach.hpp"

#include <utility>

#include "runtime/client/signature_view.hpp"
#include "runtime/localize/query/localizer.hpp"

namespace zonepack::localize {
namespace {

Eigen::Isometry3d place_of(const RigidTransform& m) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      out(row, column) = m[static_cast<std::size_t>(row * 4 + column)];
    }
  }
  return out;
}

}  // namespace

std::span<const MapFeatures* const> FeaturesInReach::in_reach_of(const QueryPrior& prior,
                                                                 const ResidentZones& resident) {
  std::map<Key, MapFeatures> kept;
  for (const ResidentZones::Zone& zone : resident.zones()) {
    const ZoneSignatures signatures(zone.view);
    for (std::uint32_t i = 0; i < signatures.size(); ++i) {
      const auto place = signatures[i].T_map_base();
      if (!place || !in_reach(place_of(*place), prior)) continue;
      const Key key(zone.zone, zone.generation, i);
      if (auto known = copies_.extract(key)) {
        kept.insert(std::move(known));
      } else if (auto copy = copy_features(signatures[i], zone.zone, descriptor_bytes_)) {
        kept.emplace(key, std::move(*copy));
      }
    }
  }
  copies_ = std::move(kept);
  chosen_.clear();
  for (const auto& [key, features] : copies_) chosen_.push_back(&features);
  return chosen_;
}

}  // namespace zonepack::localize
