// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/map_error.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/client/signature_view.hpp"
#include "runtime/odometry/poses_apart.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

std::optional<Pose2> in_plane(const std::optional<RigidTransform>& m) {
  if (!m) return std::nullopt;
  const auto at = [&](std::size_t i) { return static_cast<double>((*m)[i]); };
  const Pose2 pose{at(3), at(7), std::atan2(at(4), at(0))};
  return is_finite(pose) ? std::optional(pose) : std::nullopt;
}

}  // namespace

Outcome<MapError> MapError::read(const StoredMap& map) {
  MapError error;
  for (const CatalogZone& zone : map.catalog.zones) {
    const auto decoded = decode_zone(map.catalog, zone, kCoreOnly);
    if (!decoded) return decoded.error();
    const ZoneSignatures signatures(decoded->view());
    for (std::uint32_t i = 0; i < signatures.size(); ++i) {
      const auto truth = in_plane(signatures[i].T_world_base());
      const auto mapped = in_plane(signatures[i].T_map_base());
      if (truth && mapped) error.places_.push_back({*truth, *mapped});
    }
  }
  return error;
}

std::optional<Pose2> MapError::in_map(const Pose2& truth, double metres_a_radian) const noexcept {
  const Place* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Place& place : places_) {
    const double turned = std::abs(turn_rad(truth.yaw_rad, place.T_world_base.yaw_rad));
    const double apart = apart_m(place.T_world_base, truth) + metres_a_radian * turned;
    if (apart < least) {
      least = apart;
      nearest = &place;
    }
  }
  if (nearest == nullptr) return std::nullopt;
  return compose(nearest->T_map_base, between(nearest->T_world_base, truth));
}

}  // namespace zonepack::localize
