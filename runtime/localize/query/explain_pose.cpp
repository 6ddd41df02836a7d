// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "runtime/localize/query/localizer_state.hpp"
#include "runtime/localize/query/second_look.hpp"

namespace zonepack::localize {
namespace {

constexpr double kInlier_px = 3;
constexpr double kSecondPass_px = 8, kSecondPassEnd_px = 6;
constexpr double kSecondScale_px = 4, kSecondScaleEnd_px = 2;  // of the loss
// Where matches abound, the loss ends sharper, and what disagrees a little has less of a say; few
// matches cannot spare it.
constexpr std::size_t kManyMatches = 100;
constexpr double kSharpScaleEnd_px = 1.75;
constexpr double kSecondPassDistance = 80;  // of 256 bits
constexpr std::size_t kSecondPassSignatures = 60;
constexpr double kVisible_px = 8;
constexpr double kMuchAsNow = 0.5;  // view_change()
constexpr double kDistinct_px = 4;
// What the second look recognises counts as evidence, less what chance gives: 5 of 100 places.
// Chosen on the images of kChance (locate_near.cpp).
constexpr double kRecognised = 0.5, kRecognisedByChance = 0.05;
// Errors of the map itself, which no number of inliers averages out.
constexpr double kMapSigma_m = 0.01;
constexpr double kMapSigma_rad = 0.1 * std::numbers::pi / 180;

// The variance, along each axis, of errors of which only those below `most_px` are seen: with u =
// most^2 / (2 variance), their mean square is most^2 (1 / u - 1 / (e^u - 1)), which grows with the
// variance. Bounded by most^2: errors that fill the disc evenly say nothing about it.
double variance_of_truncated(double root_mean_square_px, double most_px) {
  const double share = std::pow(root_mean_square_px / most_px, 2);
  double least = 0.5, most = 50;  // of u
  for (int step = 0; step < 40; ++step) {
    const double u = (least + most) / 2;
    (1 / u - 1 / std::expm1(u) > share ? least : most) = u;
  }
  return most_px * most_px / (least + most);
}

std::span<const Candidate> of_second_pass(const Candidates& candidates) {
  return {candidates.reach.data(), std::min(kSecondPassSignatures, candidates.reach.size())};
}

// Near where a pose puts a point, the place says more than in the first pass.
MatchOptions second_matching(MatchOptions first) {
  first.most_distance = kSecondPassDistance;
  return first;
}

}  // namespace

// What the pose explains: inliers, distinct ones and where they are. Leaves only inliers.
void Localizer::State::count(const ImageFeatures& image, const Candidates& candidates,
                             std::vector<Sighting>& sightings, const Eigen::Isometry3d& T_map_base,
                             QueryResult& result) const {
  const Eigen::Isometry3d T_camera_map = (T_map_base * camera.T_base_camera).inverse();
  const double most2 = std::pow(kInlier_px * scale, 2);
  std::array<bool, 16> cells{};
  std::vector<Eigen::Vector2d> distinct;
  std::vector<double> weights, agreement;  // of each
  std::vector<int> of_signature(candidates.reach.size());
  double sum2 = 0;
  result.matches = static_cast<int>(sightings.size());
  result.inliers = 0;
  for (const Sighting& sighting : sightings) {
    const Eigen::Vector3d at = T_camera_map * sighting.p_map;
    const double e2 = squared_error(camera, at, sighting.px);
    const bool inlier = e2 <= most2;
    if (options.keep_matches) {
      DrawnMatch drawn;
      drawn.x_px = image.seen_px[sighting.feature].x();
      drawn.y_px = image.seen_px[sighting.feature].y();
      if (at.z() > kLeastDepth) {
        Eigen::Vector2d seen(camera.cx + camera.fx * at.x() / at.z(),
                             camera.cy + camera.fy * at.y() / at.z());
        if (camera.distorted()) seen = camera.distort(seen);
        drawn.map_x_px = static_cast<float>(seen.x());
        drawn.map_y_px = static_cast<float>(seen.y());
      }
      drawn.p_map = sighting.p_map.cast<float>();
      drawn.signature = candidates.reach[sighting.signature].map->id;
      drawn.inlier = inlier;
      result.drawn.push_back(drawn);
    }
    if (!inlier) continue;
    sum2 += e2;
    ++result.inliers;
    ++of_signature[sighting.signature];
    const double apart2 = std::pow(kDistinct_px * scale, 2);
    const auto same = std::find_if(
        distinct.begin(), distinct.end(),
        [&](const Eigen::Vector2d& px) { return (px - sighting.px).squaredNorm() < apart2; });
    if (same != distinct.end()) {
      double& best = weights[static_cast<std::size_t>(same - distinct.begin())];
      best = std::max(best, sighting.weight);
      double& agreed = agreement[static_cast<std::size_t>(same - distinct.begin())];
      agreed = std::max(agreed, sighting.weight * (1 - e2 / (2 * most2)));
      continue;
    }
    weights.push_back(sighting.weight);
    agreement.push_back(sighting.weight * (1 - e2 / (2 * most2)));
    distinct.push_back(sighting.px);
    const int column = std::clamp(static_cast<int>(sighting.px.x() * 4 / camera.width), 0, 3);
    const int row = std::clamp(static_cast<int>(sighting.px.y() * 4 / camera.height), 0, 3);
    cells[static_cast<std::size_t>(row * 4 + column)] = true;
  }
  result.distinct = static_cast<int>(distinct.size());
  result.sure = std::accumulate(weights.begin(), weights.end(), 0.0);
  result.evidence = std::accumulate(agreement.begin(), agreement.end(), 0.0);
  result.cells = static_cast<int>(std::count(cells.begin(), cells.end(), true));
  result.residual_px = result.inliers > 0 ? std::sqrt(sum2 / result.inliers) : 0;
  if (!of_signature.empty()) {
    const auto most = std::max_element(of_signature.begin(), of_signature.end());
    const MapFeatures& best =
        *candidates.reach[static_cast<std::size_t>(most - of_signature.begin())].map;
    result.best = best.id;
    result.best_zone = best.zone;
  }
}

// From a pose on the plane to the pose in space, over the points of all candidates.
void Localizer::State::polish(const ImageFeatures& image, const Candidates& candidates,
                              const Eigen::Isometry3d& start, QueryResult& result) const {
  const std::span<const Candidate> all = of_second_pass(candidates);
  Refined refined;
  refined.T_map_base = start;
  std::vector<Sighting> sightings;
  const MatchOptions second = second_matching(matching());
  for (const double radius : {kSecondPass_px, kSecondPassEnd_px}) {
    sightings = match_projected(image, all, camera, refined.T_map_base, radius * scale, second);
    if (sightings.size() < 4) break;
    const bool sharp = radius == kSecondPassEnd_px && sightings.size() >= kManyMatches;
    refined = refine_on_floor(sightings, candidates, refined.T_map_base, kSecondScale_px,
                              sharp ? kSharpScaleEnd_px : kSecondScaleEnd_px);
    if (!refined.valid) break;
  }
  count(image, candidates, sightings, refined.T_map_base, result);
  result.visible = count_visible(image, all, camera, refined.T_map_base, kVisible_px * scale);
  result.floor_z_m = candidates.floor_z_m;
  result.found = refined.valid;
  result.T_map_base = refined.T_map_base;
  result.pose = flatten(refined.T_map_base);
  // Several signatures see one feature with the same error: only distinct ones count.
  const double repeated =
      std::max(1.0, static_cast<double>(result.inliers) / std::max(1, result.distinct));
  const double worse =
      repeated * std::max(1.0, 2 * variance_of_truncated(result.residual_px / scale, kInlier_px));
  const Covariance2& c = refined.covariance;
  result.covariance = {c.xx * worse + kMapSigma_m * kMapSigma_m,
                       c.xy * worse,
                       c.x_yaw * worse,
                       c.yy * worse + kMapSigma_m * kMapSigma_m,
                       c.y_yaw * worse,
                       c.yaw_yaw * worse + kMapSigma_rad * kMapSigma_rad};
}

// Points behind a wall, or that were seen from the other side, are no reason to expect anything.
int Localizer::State::count_expected(const ImageFeatures& image, const Candidates& candidates,
                                     const Eigen::Isometry3d& T_map_base) const {
  return count_visible(image, of_second_pass(candidates), camera, T_map_base, kVisible_px * scale,
                       kMuchAsNow);
}

void Localizer::State::weigh_second_look(const ImageFeatures& image, PlaceDescriber& describer,
                                         const Candidates& candidates, QueryResult& result) {
  const std::span<const Candidate> all = of_second_pass(candidates);
  const std::vector<Sighting> matched =
      match_projected(image, all, camera, result.T_map_base, kSecondPassEnd_px * scale,
                      second_matching(matching()));
  const SecondLook look = take_second_look(describer, all, camera, result.T_map_base, matched);
  result.looked_at = look.points;
  result.recognised = look.recognised;
  result.evidence += kRecognised * (look.recognised - kRecognisedByChance * look.points);
}

}  // namespace zonepack::localize
