// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/localize/query/localizer_state.hpp"
#include "runtime/localize/query/place_search.hpp"
#include "runtime/localize/solve/planar_ransac.hpp"
#include "runtime/odometry/poses_apart.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

constexpr std::size_t kFirstPassSignatures = 12;
// Poses that are worth a second pass: the best of RANSAC and those nearly as good.
constexpr std::size_t kStarts = 3;
constexpr double kStartShare = 0.85;
constexpr double kPlenty = 3;  // times the evidence needed: no other start is looked at
// Before a pose is believed, poses elsewhere are asked whether they explain the image about as
// well: those that came next in RANSAC.
constexpr std::size_t kMostRivals = 6;
constexpr double kRivalStartShare = 0.5, kRivalEvidence = 0.8;
constexpr double kRivalApart_m = 0.25, kRivalApart_rad = 2 * std::numbers::pi / 180;
constexpr double kFirstScale_px = 8, kFirstScaleEnd_px = 3;  // of the loss
constexpr double kMostTilt_rad = 6 * std::numbers::pi / 180;
constexpr double kMostLift_m = 0.12;
// The evidence for a pose: each distinct inlier counts by how alike its descriptors are and how
// well it agrees, less what chance gives (4 in 100 features near a projected point: a dense map
// gives more wrong inliers than a sparse one), less what the prior says against the pose. Chosen
// among some 150 settings on two missions of two maps, images undisturbed and spoilt in eight ways.
constexpr double kChance = 0.04, kOffPrior = 0.5;
// A pose with less of it than this is looked at again, if the image is there.
constexpr double kBeyondDoubt = kLeastEvidence + 1;
constexpr double kMostSigma_m = 0.1;  // a vaguer pose is of no use

// How far a pose is from the prior, as a squared Mahalanobis distance.
double off_prior2(const QueryPrior& prior, const QueryResult& result) {
  Covariance2 around = prior.covariance;
  around.xx += 0.01;
  around.yy += 0.01;
  around.yaw_yaw += 1e-3;
  return mahalanobis2({prior.T_map_base, around}, {result.pose, result.covariance});
}

bool rivals(const QueryResult& other, const QueryResult& best) {
  return other.found && other.evidence >= kLeastEvidence &&
         other.evidence > kRivalEvidence * best.evidence &&
         !are_within(other.pose, best.pose, kRivalApart_m, kRivalApart_rad);
}

std::size_t count_features(const std::vector<Sighting>& sightings) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    count += i == 0 || sightings[i].feature != sightings[i - 1].feature ? 1 : 0;
  }
  return count;
}

}  // namespace

void Localizer::State::locate_near(const ImageFeatures& image, const GreyImage* pixels,
                                   std::span<const MapFeatures* const> map, const QueryPrior& prior,
                                   QueryResult& result) {
  StageClock clock(result);
  const Candidates candidates = choose_candidates(map, camera, prior, kFirstPassSignatures);
  result.signatures = static_cast<int>(candidates.best.size());
  if (candidates.nearest != nullptr) {
    result.nearest = candidates.nearest->id;
    result.nearest_zone = candidates.nearest->zone;
    result.nearest_m = candidates.nearest_m;
    result.nearest_turn_rad = candidates.nearest_turn_rad;
  }
  clock.end(Stage::kSelect);
  if (candidates.best.empty()) {
    result.reason = candidates.near == 0 ? Reason::kNoSignature : Reason::kNotInView;
    return;
  }
  std::optional<PlaceDescriber> describer;
  if (pixels != nullptr && detector.describes_anywhere()) describer.emplace(detector, *pixels);
  std::vector<Sighting> sightings =
      match_in_windows(image, candidates.best, camera, prior, candidates.floor_z_m, matching());
  clock.end(Stage::kMatch);
  const QueryResult before = result;
  solve(image, describer ? &*describer : nullptr, candidates, sightings, prior, result);
  if (result.accepted || !describer) return;
  StageClock again(result);
  ImageFeatures more = image;
  const std::vector<Sighting> found =
      find_places(*describer, candidates, camera, prior, matching(), more);
  sightings.insert(sightings.end(), found.begin(), found.end());
  again.end(Stage::kMatch);
  QueryResult second = before;
  second.places_found = static_cast<int>(found.size());
  second.cpu_ns = result.cpu_ns;
  second.cpu_total_ns = result.cpu_total_ns;
  solve(more, &*describer, candidates, sightings, prior, second);
  if (second.accepted || second.evidence > result.evidence) {
    result = std::move(second);
  } else {
    result.places_found = second.places_found;
    result.cpu_ns = second.cpu_ns;
    result.cpu_total_ns = second.cpu_total_ns;
  }
}

// From matches to the best pose, and what is thought of it.
void Localizer::State::solve(const ImageFeatures& image, PlaceDescriber* describer,
                             const Candidates& candidates, const std::vector<Sighting>& sightings,
                             const QueryPrior& prior, QueryResult& result) {
  StageClock clock(result);
  result.matches = static_cast<int>(sightings.size());
  if (count_features(sightings) < 4) {
    result.reason = Reason::kFewMatches;
    return;
  }
  RansacOptions ransac;
  ransac.seed = options.seed;
  ransac.threshold_px *= scale;
  ransac.most_poses = kMostRivals;
  const PoseGate gate{prior.T_map_base, 0.3 + 3.5 * position_sigma_m(prior.covariance),
                      0.05 + 3.5 * std::sqrt(std::max(0.0, prior.covariance.yaw_yaw))};
  const auto planar = find_planar(sightings, camera, candidates.floor_z_m, gate, ransac);
  clock.end(Stage::kRansac);
  if (planar.empty()) {
    result.reason = Reason::kFewInliers;
    return;
  }
  const QueryResult before = result;
  const auto from = [&](const PlanarPose& start) {
    const Eigen::Isometry3d lifted = lift(start.pose, candidates.floor_z_m);
    const Refined first =
        refine_on_floor(sightings, candidates, lifted, kFirstScale_px, kFirstScaleEnd_px);
    QueryResult here = before;
    polish(image, candidates, first.valid ? first.T_map_base : lifted, here);
    here.evidence -= kChance * here.visible + kOffPrior * off_prior2(prior, here);
    return here;
  };
  std::vector<QueryResult> tried;
  std::size_t best = 0;
  for (const PlanarPose& start : planar) {
    if (tried.size() == kStarts || start.score < kStartShare * planar.front().score) break;
    if (!tried.empty() && tried[best].evidence > kPlenty * kLeastEvidence) break;
    tried.push_back(from(start));
    if (tried.back().evidence > tried[best].evidence) best = tried.size() - 1;
  }
  result = tried[best];
  if (describer != nullptr && result.found && result.distinct >= options.needed &&
      result.evidence < kBeyondDoubt) {
    weigh_second_look(image, *describer, candidates, result);
  }
  judge(candidates, prior, result);
  const bool beyond_rivals = result.evidence > kPlenty * kLeastEvidence;
  for (std::size_t i = 0; i < planar.size() && result.accepted && !beyond_rivals; ++i) {
    if (planar[i].score < kRivalStartShare * planar.front().score) break;
    if (i == tried.size()) tried.push_back(from(planar[i]));
    if (!rivals(tried[i], result)) continue;
    result.accepted = false;
    result.reason = Reason::kRival;
  }
  if (result.found && !result.accepted) {
    result.expected = count_expected(image, candidates, result.T_map_base);
  }
  clock.end(Stage::kRefine);
}

void Localizer::State::judge(const Candidates& candidates, const QueryPrior& prior,
                             QueryResult& result) const {
  const auto refuse = [&](Reason reason) { result.reason = reason; };
  result.accepted = false;
  if (!result.found || result.distinct < options.needed) return refuse(Reason::kFewInliers);
  if (result.evidence < kLeastEvidence) return refuse(Reason::kChance);
  if (result.cells < options.needed_cells) return refuse(Reason::kGathered);
  const Eigen::Vector3d up = result.T_map_base.linear().col(2);
  const double lift_m = result.T_map_base.translation().z() - candidates.floor_z_m;
  if (up.z() < std::cos(kMostTilt_rad) || std::abs(lift_m) > kMostLift_m) {
    return refuse(Reason::kNotLevel);
  }
  if (position_sigma_m(result.covariance) > kMostSigma_m) return refuse(Reason::kUnsure);
  // 4 standard deviations of three values: 1 in 900 of right ones.
  if (off_prior2(prior, result) > 18) {
    return refuse(Reason::kFarFromPrior);
  }
  result.accepted = true;
  result.reason = Reason::kAccepted;
}

}  // namespace zonepack::localize
