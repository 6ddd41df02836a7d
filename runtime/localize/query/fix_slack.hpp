// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

// How far ahead zones are of use: of their signatures, those at most so far behind a wall's door
// still share points with the image. Measured: 8 to 12 m find the same, 6 m finds less.
inline constexpr double kView_m = 10;

// The prior for a query from the pose that zoned believes. The pose follows earlier fixes, which
// share the map's errors where they were made; a few metres on, the map is bent otherwise.
inline QueryPrior with_map_slack(QueryPrior prior) {
  constexpr double kBent_m = 0.1, kBent_rad = 2 * std::numbers::pi / 180;
  prior.covariance.xx += kBent_m * kBent_m;
  prior.covariance.yy += kBent_m * kBent_m;
  prior.covariance.yaw_yaw += kBent_rad * kBent_rad;
  return prior;
}

}  // namespace zonepack::localize
