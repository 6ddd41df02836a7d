// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "runtime/localize/query/localizer_state.hpp"
#include "runtime/localize/solve/planar_ransac.hpp"
#include "runtime/odometry/poses_apart.hpp"

namespace zonepack::localize {
namespace {

constexpr std::size_t kLostPlaces = 5;
constexpr double kLostReach_m = 3, kLostTurn_rad = 60 * std::numbers::pi / 180;
constexpr double kRivalShare = 0.6;
constexpr double kSamePlace_m = 1, kSameYaw_rad = 20 * std::numbers::pi / 180;

}  // namespace

// Every signature by brute force; those that a pose on the plane explains best are looked at with
// their neighbours.
void Localizer::State::locate_anywhere(const ImageFeatures& image,
                                       std::span<const MapFeatures* const> map,
                                       QueryResult& result) {
  StageClock clock(result);
  struct Place {
    PlanarPose planar;
    const MapFeatures* map;
  };
  std::vector<Place> places;
  for (const MapFeatures* const one : map) {
    if (one->points.empty()) continue;
    ++result.signatures;
    const std::vector<Sighting> sightings = match_everywhere(image, *one, matching());
    clock.end(Stage::kMatch);
    if (sightings.size() < 5) continue;
    RansacOptions ransac;
    ransac.seed = options.seed;
    ransac.iterations = 120;
    ransac.threshold_px *= scale;
    const PoseGate gate{flatten(one->T_map_base), kLostReach_m, kLostTurn_rad};
    const auto planar =
        find_planar(sightings, camera, one->T_map_base.translation().z(), gate, ransac);
    clock.end(Stage::kRansac);
    if (!planar.empty() && planar.front().features >= 5) places.push_back({planar.front(), one});
  }
  if (result.signatures == 0) {
    result.reason = Reason::kNoSignature;
    return;
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.planar.score > b.planar.score; });
  const auto same = [](const Pose2& a, const Pose2& b) {
    return are_within(a, b, kSamePlace_m, kSameYaw_rad);
  };
  std::vector<QueryResult> found;
  std::vector<Pose2> tried;
  for (const Place& place : places) {
    if (tried.size() >= kLostPlaces) break;
    if (std::any_of(tried.begin(), tried.end(),
                    [&](const Pose2& other) { return same(other, place.planar.pose); })) {
      continue;
    }
    tried.push_back(place.planar.pose);
    const QueryPrior prior{place.planar.pose, {0.04, 0, 0, 0.04, 0, 0.002}};
    QueryResult local;
    locate_near(image, nullptr, map, prior, local);
    result.cpu_total_ns += local.cpu_total_ns;
    for (std::size_t i = 0; i < kStages; ++i) result.cpu_ns[i] += local.cpu_ns[i];
    if (local.found) found.push_back(std::move(local));
  }
  if (found.empty()) {
    result.reason = places.empty() ? Reason::kFewMatches : Reason::kFewInliers;
    return;
  }
  std::stable_sort(found.begin(), found.end(), [](const QueryResult& a, const QueryResult& b) {
    return a.distinct > b.distinct;
  });
  QueryResult& best = found.front();
  for (std::size_t i = 1; i < found.size() && best.accepted; ++i) {
    if (!same(best.pose, found[i].pose) && found[i].distinct > kRivalShare * best.distinct) {
      best.accepted = false;
      best.reason = Reason::kRival;
    }
  }
  best.cpu_ns = result.cpu_ns;
  best.cpu_total_ns = result.cpu_total_ns;
  best.signatures = result.signatures;
  best.features = result.features;
  result = std::move(best);
}

}  // namespace zonepack::localize
