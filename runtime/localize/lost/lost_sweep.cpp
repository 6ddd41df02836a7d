// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/lost_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {
namespace {

constexpr double kSlip = 0.03;  // of the way or turn, as a standard deviation
constexpr double kLeastCarried_m = 0.02, kLeastCarried_rad = 0.005;

}  // namespace

std::vector<FoundFix> fixes_at(std::span<const ViewMoment> moments, const LostSearch& search,
                               const LostPlace& place) {
  std::vector<FoundFix> fixes;
  for (const ViewMoment& moment : moments) {
    FoundFix fix;
    fix.stamp_ns = moment.stamp_ns;
    // Of the views that agree the one itself, or the best.
    std::size_t from = 0;
    for (std::size_t i = 0; i < place.views.size(); ++i) {
      if (search.views()[place.views[i]].stamp_ns == moment.stamp_ns) {
        from = i;
        fix.seen = place.sights[i];
      }
    }
    const Sight& sight = place.sights[from];
    const Pose2 step =
        between(search.views()[place.views[from]].T_wheels_base, moment.T_wheels_base);
    fix.pose = fix.seen ? sight.pose : compose(sight.pose, step);
    fix.sigma_m = position_sigma_m(sight.covariance);
    fix.sigma_rad = std::sqrt(sight.covariance.yaw_yaw);
    if (!fix.seen) {
      fix.sigma_m += kLeastCarried_m + kSlip * std::hypot(step.x_m, step.y_m);
      fix.sigma_rad += kLeastCarried_rad + kSlip * std::abs(step.yaw_rad);
    }
    fixes.push_back(fix);
  }
  return fixes;
}

LostSweep::LostSweep(std::vector<SearchZone> map, PlaceMatcher& matcher, const LostRule& rule)
    : map_(std::move(map)), search_(matcher, rule) {}

void LostSweep::begin(std::int64_t now_ns, ZoneId last) {
  active_ = true;
  order_ = search_order(map_, last);
  looks_.assign(map_.size(), 0);
  led_ = false;
  failed_.assign(map_.size(), 0);
  turn_asked_ns_.reset();
  waiting_ = kNoZone;
  waiting_since_ns_ = now_ns;
  forget_views();
}

void LostSweep::end() {
  active_ = false;
  forget_views();
}

void LostSweep::forget_views() {
  search_.restart();
  moments_.clear();
  views_ = 0;
  std::fill(failed_.begin(), failed_.end(), 0);
}

void LostSweep::see(LostView view) {
  if (moments_.size() == kMostMoments) moments_.erase(moments_.begin());
  moments_.push_back({view.stamp_ns, view.T_wheels_base});
  if (search_.add(std::move(view))) ++views_;
}

bool LostSweep::may_try(ZoneId zone) const noexcept {
  return search_.unmatched(zone) > 0 && failed_[zone] != views_ + 1;
}

ZoneId LostSweep::next(std::int64_t now_ns, const std::function<bool(ZoneId)>& resident) {
  if (!active_ || search_.views().empty()) return kNoZone;
  // What is being loaded is waited for: each zone is read once in a round.
  if (waiting_ != kNoZone && !resident(waiting_)) {
    if (now_ns - waiting_since_ns_ < kPatience_ns) return waiting_;
    passed_over_.push_back(waiting_);
    failed_[waiting_] = static_cast<std::size_t>(views_ + 1);
    waiting_ = kNoZone;
  }
  const ZoneId zone = waiting_ != kNoZone ? waiting_ : choose(resident);
  waiting_ = kNoZone;
  if (zone == kNoZone || resident(zone)) return zone;
  waiting_ = zone;
  waiting_since_ns_ = now_ns;
  return zone;
}

// Once the whole map was seen, every second look goes to where the best places are.
ZoneId LostSweep::choose(const std::function<bool(ZoneId)>& resident) const {
  if (looked_at() == order_.size() && !led_) {
    const std::vector<ZoneId> leading = search_.leading_zones();
    const std::size_t count = std::min(leading.size(), kMostLeading);
    for (const ZoneId zone : std::span(leading).first(count)) {
      if (may_try(zone)) return zone;
    }
  }
  // Those that were looked at least often; among these what is in memory.
  ZoneId best = kNoZone;
  for (const ZoneId zone : order_) {
    if (!may_try(zone)) continue;
    const auto rank = [&](ZoneId one) { return std::pair(looks_[one], resident(one) ? 0 : 1); };
    if (best == kNoZone || rank(zone) < rank(best)) best = zone;
  }
  return best;
}

std::size_t LostSweep::look(ZoneId zone, std::span<const MapFeatures* const> map) {
  ++looks_[zone];
  led_ = !led_;
  return search_.match(zone, map);
}

std::size_t LostSweep::looked_at() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(looks_.begin(), looks_.end(), [](std::size_t looks) { return looks > 0; }));
}

bool LostSweep::asks_for_turn(std::int64_t now_ns) {
  if (!active_ || views_ == 0) return false;
  if (turn_asked_ns_ && now_ns - *turn_asked_ns_ < kTurnAgain_ns) return false;
  const bool all = std::all_of(order_.begin(), order_.end(),
                               [&](ZoneId zone) { return looks_[zone] > 0 || failed_[zone] != 0; });
  if (!all) return false;
  turn_asked_ns_ = now_ns;
  return true;
}

std::vector<FoundFix> LostSweep::found(std::int64_t now_ns) const {
  if (!active_) return {};
  const auto place = search_.leading();
  if (!place || !search_.found(*place)) return {};
  std::vector<ViewMoment> newest;
  for (const ViewMoment& moment : moments_) {
    if (now_ns - moment.stamp_ns <= kOldest_ns) newest.push_back(moment);
  }
  if (newest.size() < 2) return {};  // the next images are worth the wait
  return fixes_at(newest, search_, *place);
}

}  // namespace zonepack::localize
