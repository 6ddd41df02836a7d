// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/place_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/localize/query/matching.hpp"
#include "runtime/localize/solve/planar_ransac.hpp"
#include "runtime/odometry/poses_apart.hpp"

namespace zonepack::localize {
namespace {

constexpr double kLostFocal_px = 385;  // thresholds in pixels are of a camera like this
constexpr int kGuessTries = 120;
constexpr int kLeastPlanar = 6;  // features that a pose on the plane has to explain
// From a signature: a camera farther away or turned more sees little of the same.
constexpr double kGuessReach_m = 3, kGuessReach_rad = 60 * std::numbers::pi / 180;
constexpr double kSameGuess_m = 0.6, kSameGuess_rad = 12 * std::numbers::pi / 180;
constexpr Covariance2 kAroundGuess{0.04, 0, 0, 0.04, 0, 0.002};
constexpr int kLeastDistinct = 8;

}  // namespace

ImageMatcher::ImageMatcher(Localizer& localizer, const DetectorSettings& detector)
    : localizer_(localizer), binary_(detector.binary()) {}

std::vector<Sight> ImageMatcher::guess(const LostView& view, ZoneId,
                                       std::span<const MapFeatures* const> map) {
  const CameraModel& camera = localizer_.camera();
  const double scale = camera.fx / kLostFocal_px;
  MatchOptions matching;
  matching.binary = binary_;
  std::vector<PlanarPose> places;
  for (const MapFeatures* const one : map) {
    if (one->points.empty()) continue;
    const std::vector<Sighting> sightings = match_everywhere(view.features, *one, matching);
    if (sightings.size() < static_cast<std::size_t>(kLeastPlanar)) continue;
    RansacOptions ransac;
    ransac.seed = localizer_.options().seed;
    ransac.iterations = kGuessTries;
    ransac.threshold_px *= scale;
    const auto found =
        find_planar(sightings, camera, one->T_map_base.translation().z(),
                    {flatten(one->T_map_base), kGuessReach_m, kGuessReach_rad}, ransac);
    if (!found.empty() && found.front().features >= kLeastPlanar) places.push_back(found.front());
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const PlanarPose& a, const PlanarPose& b) { return a.score > b.score; });
  std::vector<Sight> sights;
  std::vector<Pose2> tried;
  for (const PlanarPose& place : places) {
    if (tried.size() == kMostPlaces) break;
    const auto same = [&](const Pose2& other) {
      return are_within(other, place.pose, kSameGuess_m, kSameGuess_rad);
    };
    if (std::any_of(tried.begin(), tried.end(), same)) continue;
    tried.push_back(place.pose);
    const QueryResult result =
        localizer_.locate(view.features, map, QueryPrior{place.pose, kAroundGuess});
    if (result.found && result.distinct >= kLeastDistinct) sights.push_back(sight_of(result));
  }
  std::stable_sort(sights.begin(), sights.end(),
                   [](const Sight& a, const Sight& b) { return a.distinct > b.distinct; });
  return sights;
}

std::optional<Sight> ImageMatcher::check(const LostView& view, ZoneId,
                                         std::span<const MapFeatures* const> map,
                                         const QueryPrior& prior) {
  const QueryResult result = localizer_.locate(view.features, map, prior);
  if (result.signatures == 0) return std::nullopt;
  return sight_of(result);
}

}  // namespace zonepack::localize
