// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/replay/map_error.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/client/signature_view.hpp"
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

Outcome<MapError> MapError::read(const MapFolder& map) {
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

std::optional<Pose2> MapError::in_map(const Pose2& truth) const noexcept {
  // A map bends from one pass of its drive to the next, and where two passes went opposite ways
  // the camera sees what one of them saw: a radian counts as a metre.
  const Place* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Place& place : places_) {
    const double dx = place.T_world_base.x_m - truth.x_m, dy = place.T_world_base.y_m - truth.y_m;
    const double turned =
        std::remainder(place.T_world_base.yaw_rad - truth.yaw_rad, 2 * std::numbers::pi);
    const double apart = std::hypot(dx, dy) + std::abs(turned);
    if (apart < least) {
      least = apart;
      nearest = &place;
    }
  }
  if (nearest == nullptr) return std::nullopt;
  return compose(nearest->T_map_base, between(nearest->T_world_base, truth));
}

}  // namespace zonepack::localize
