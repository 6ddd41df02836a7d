// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/localize/lost/place_matcher.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {

// A matcher that says what a test tells it: sights by image and zone. A second look at a place sees
// what was told for a place within 0.3 m of it, or nothing.
class MadePlaces final : public PlaceMatcher {
 public:
  std::map<std::pair<std::uint64_t, ZoneId>, std::vector<Sight>> guesses, second;
  int looks = 0;

  std::vector<Sight> guess(const LostView& view, ZoneId zone,
                           std::span<const MapFeatures* const>) override {
    ++looks;
    return guesses[{view.number, zone}];
  }
  std::optional<Sight> check(const LostView& view, ZoneId zone, std::span<const MapFeatures* const>,
                             const QueryPrior& prior) override {
    for (const Sight& sight : second[{view.number, zone}]) {
      const Pose2 off = between(prior.T_map_base, sight.pose);
      if (std::hypot(off.x_m, off.y_m) < 0.3) return sight;
    }
    return std::nullopt;
  }
};

inline LostView made_view(std::uint64_t number, double x_m, double yaw_rad = 0) {
  LostView view;
  view.number = number;
  view.stamp_ns = static_cast<std::int64_t>(number) * 500'000'000;
  view.T_wheels_base = {x_m, 0, yaw_rad};
  return view;
}

inline Sight made_sight(Pose2 pose, int distinct, int visible, bool accepted = true) {
  return {pose, {0.0004, 0, 0, 0.0004, 0, 0.0001}, distinct, visible, visible, accepted};
}

}  // namespace zonepack::localize
