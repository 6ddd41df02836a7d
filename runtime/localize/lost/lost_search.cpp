// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/lost_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "runtime/odometry/poses_apart.hpp"
#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Two views agree when the wheels carry one's place to the other's within this, and a share of the
// way and turn between them: wheels slip.
constexpr double kAgree_m = 0.25, kAgreePerMetre = 0.05;
constexpr double kAgree_rad = 4 * kDegree, kAgreePerRadian = 0.05;
// Another place than that: a rival.
constexpr double kElsewhere_m = 1, kElsewhere_rad = 20 * kDegree;
constexpr std::size_t kSeeds = 80;  // strongest sights that a place is tried around
constexpr std::size_t kLeaders = 3;
constexpr double kLeaderShare = 0.5;  // of the support of the first
// A place that was looked at again is not once more from so near.
constexpr double kSameCheck_m = 0.15, kSameCheck_rad = 2 * kDegree;

bool elsewhere(const Pose2& a, const Pose2& b) {
  return apart_m(a, b) > kElsewhere_m || std::abs(turn_rad(a.yaw_rad, b.yaw_rad)) > kElsewhere_rad;
}

}  // namespace

bool LostSearch::add(LostView view) {
  if (!views_.empty()) {
    const Pose2 step = between(views_.back().T_wheels_base, view.T_wheels_base);
    if (std::hypot(step.x_m, step.y_m) < kApart_m && std::abs(step.yaw_rad) < kApart_rad) {
      return false;
    }
  }
  if (views_.size() == kMostViews) {
    // Of those that support no leading place the oldest, else the oldest.
    const auto lead = leading();
    std::size_t goes = 0;
    if (lead) {
      const auto supports = [&](std::size_t i) {
        return std::find(lead->views.begin(), lead->views.end(), i) != lead->views.end();
      };
      while (goes + 1 < views_.size() && supports(goes)) ++goes;
      if (supports(goes)) goes = 0;
    }
    const std::uint64_t number = views_[goes].number;
    std::erase_if(seen_, [&](const Seen& seen) { return seen.view == goes; });
    for (Seen& seen : seen_) seen.view -= seen.view > goes ? 1 : 0;
    std::erase_if(checked_, [&](const Checked& checked) { return checked.view == number; });
    views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(goes));
    matched_.erase(matched_.begin() + static_cast<std::ptrdiff_t>(goes));
  }
  views_.push_back(std::move(view));
  matched_.emplace_back();
  return true;
}

void LostSearch::restart() {
  views_.clear();
  seen_.clear();
  checked_.clear();
  matched_.clear();
}

std::size_t LostSearch::unmatched(ZoneId zone) const noexcept {
  return static_cast<std::size_t>(std::count_if(
      matched_.begin(), matched_.end(),
      [&](const std::vector<bool>& by_zone) { return zone >= by_zone.size() || !by_zone[zone]; }));
}

std::size_t LostSearch::match(ZoneId zone, std::span<const MapFeatures* const> map) {
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    std::vector<bool>& by_zone = matched_[i];
    if (zone >= by_zone.size()) by_zone.resize(zone + 1);
    if (by_zone[zone]) continue;
    by_zone[zone] = true;
    pairs += map.size();
    for (const Sight& sight : matcher_.guess(views_[i], zone, map)) {
      seen_.push_back({i, zone, sight, compose(sight.pose, inverse(views_[i].T_wheels_base))});
    }
  }
  look_again(zone, map);
  return pairs;
}

bool LostSearch::counts(const Sight& sight) const noexcept {
  return sight.distinct >= rule_.least_distinct &&
         sight.distinct >= rule_.least_explained * sight.visible;
}

double LostSearch::evidence(const Sight& sight) const noexcept {
  return std::max(0.0, sight.distinct - rule_.chance * sight.visible);
}

Pose2 LostSearch::carried(const Seen& from, std::size_t to) const noexcept {
  return compose(from.T_map_wheels, views_[to].T_wheels_base);
}

bool LostSearch::agree(const Seen& a, const Seen& b) const noexcept {
  const Pose2 step = between(views_[a.view].T_wheels_base, views_[b.view].T_wheels_base);
  const Pose2 there = carried(a, b.view);
  return apart_m(there, b.sight.pose) <=
             kAgree_m + kAgreePerMetre * std::hypot(step.x_m, step.y_m) &&
         std::abs(turn_rad(there.yaw_rad, b.sight.pose.yaw_rad)) <=
             kAgree_rad + kAgreePerRadian * std::abs(step.yaw_rad);
}

// The best sight of each view that agrees with the centre's. all: also those that do not count.
LostSearch::Cluster LostSearch::around(const Seen& centre, bool all) const {
  std::vector<const Seen*> best(views_.size());
  for (const Seen& seen : seen_) {
    if (!all && !counts(seen.sight)) continue;
    if (!agree(centre, seen)) continue;
    const Seen*& here = best[seen.view];
    if (here == nullptr || seen.sight.distinct > here->sight.distinct) here = &seen;
  }
  std::vector<const Seen*> chosen;
  for (const Seen* const seen : best) {
    if (seen != nullptr) chosen.push_back(seen);
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const Seen* a, const Seen* b) {
    return a->sight.distinct > b->sight.distinct;
  });
  Cluster out;
  LostPlace& place = out.place;
  place.T_map_wheels = centre.T_map_wheels;
  for (const Seen* const seen : chosen) {
    place.views.push_back(seen->view);
    place.sights.push_back(seen->sight);
    place.evidence += evidence(seen->sight);
    if (std::find(out.zones.begin(), out.zones.end(), seen->zone) == out.zones.end()) {
      out.zones.push_back(seen->zone);
    }
    for (const std::size_t other : place.views) {
      const Pose2 step = between(views_[other].T_wheels_base, views_[seen->view].T_wheels_base);
      place.moved_m = std::max(place.moved_m, std::hypot(step.x_m, step.y_m));
      place.turned_rad = std::max(place.turned_rad, std::abs(step.yaw_rad));
    }
  }
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (best[i] != nullptr) continue;
    const Pose2 here = compose(centre.T_map_wheels, views_[i].T_wheels_base);
    const bool against = std::any_of(checked_.begin(), checked_.end(), [&](const Checked& checked) {
      return checked.view == views_[i].number && !elsewhere(checked.pose, here) &&
             speaks_against(checked.distinct, checked.expected, rule_.should_see,
                            rule_.least_explained);
    });
    place.against += against ? 1 : 0;
  }
  place.support = place.evidence - rule_.against_costs * place.against;
  return out;
}

std::vector<LostSearch::Cluster> LostSearch::clusters(std::size_t most, bool all) const {
  std::vector<const Seen*> seeds;
  for (const Seen& seen : seen_) {
    if (all || counts(seen.sight)) seeds.push_back(&seen);
  }
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seen* a, const Seen* b) {
    return a->sight.distinct > b->sight.distinct;
  });
  if (seeds.size() > kSeeds) seeds.resize(kSeeds);
  std::vector<Cluster> found;
  for (const Seen* const seed : seeds) found.push_back(around(*seed, all));
  std::stable_sort(found.begin(), found.end(), [](const Cluster& a, const Cluster& b) {
    return a.place.evidence > b.place.evidence;
  });
  std::vector<Cluster> apart;
  for (Cluster& cluster : found) {
    if (apart.size() == most) break;
    const auto same = [&](const Cluster& other) {
      const Pose2 wheels = views_[cluster.place.views.front()].T_wheels_base;
      return !elsewhere(compose(other.place.T_map_wheels, wheels),
                        compose(cluster.place.T_map_wheels, wheels));
    };
    if (std::none_of(apart.begin(), apart.end(), same)) apart.push_back(std::move(cluster));
  }
  return apart;
}

bool LostSearch::was_checked(std::uint64_t view, ZoneId zone, const Pose2& pose) const noexcept {
  return std::any_of(checked_.begin(), checked_.end(), [&](const Checked& checked) {
    return checked.view == view && checked.zone == zone &&
           are_within(checked.pose, pose, kSameCheck_m, kSameCheck_rad);
  });
}

// Each leading place: every view where the wheels say it was.
void LostSearch::look_again(ZoneId zone, std::span<const MapFeatures* const> map) {
  const std::vector<Cluster> leaders = clusters(kLeaders, true);
  for (const Cluster& cluster : leaders) {
    if (cluster.place.evidence < kLeaderShare * leaders.front().place.evidence) break;
    const std::size_t first = cluster.place.views.front();
    const Pose2 T_map_wheels =
        compose(cluster.place.sights.front().pose, inverse(views_[first].T_wheels_base));
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Pose2 there = compose(T_map_wheels, views_[i].T_wheels_base);
      if (was_checked(views_[i].number, zone, there)) continue;
      const Pose2 step = between(views_[first].T_wheels_base, views_[i].T_wheels_base);
      const double sigma_m = 0.1 + 0.03 * std::hypot(step.x_m, step.y_m);
      const double sigma_rad = 0.03 + 0.03 * std::abs(step.yaw_rad);
      const QueryPrior prior{
          there, {sigma_m * sigma_m, 0, 0, sigma_m * sigma_m, 0, sigma_rad * sigma_rad}};
      const auto sight = matcher_.check(views_[i], zone, map, prior);
      checked_.push_back({views_[i].number, zone, there, sight ? sight->expected : 0,
                          sight ? sight->distinct : 0});
      if (sight && sight->accepted) {
        seen_.push_back({i, zone, *sight, compose(sight->pose, inverse(views_[i].T_wheels_base))});
      }
    }
  }
}

std::optional<LostPlace> LostSearch::leading() const {
  std::vector<Cluster> best = clusters(2, false);
  if (best.empty()) return std::nullopt;
  LostPlace place = std::move(best.front().place);
  if (best.size() > 1) place.rival = best[1].place.evidence;
  return place;
}

bool LostSearch::found(const LostPlace& place) const noexcept {
  const bool moved = place.moved_m >= rule_.moved_m ||
                     (place.views.size() > 2 && place.turned_rad >= rule_.turned_rad);
  return moved && place.support >= rule_.least_support &&
         place.rival <= rule_.most_rival * place.evidence;
}

std::vector<ZoneId> LostSearch::leading_zones() const {
  std::vector<ZoneId> zones;
  for (const Cluster& cluster : clusters(kLeaders, true)) {
    for (const ZoneId zone : cluster.zones) {
      if (std::find(zones.begin(), zones.end(), zone) == zones.end()) zones.push_back(zone);
    }
  }
  return zones;
}

}  // namespace zonepack::localize
