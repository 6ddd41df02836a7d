// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/expected_use.hpp"

#include <algorithm>

namespace zonepack {

std::unique_ptr<EvictionOrder> make_expected_use(const EvictionPlace& place) {
  return std::make_unique<ExpectedUse>(place);
}

ExpectedUse::ExpectedUse(const EvictionPlace& place)
    : forecast_(*place.transitions),
      shadow_(place.needs, place.slots),
      most_loss_(static_cast<std::int64_t>(kMostLoss * static_cast<double>(place.slots))),
      most_credit_(static_cast<std::int64_t>(kMostCredit * static_cast<double>(place.slots))) {}

void ExpectedUse::begin_cycle(const EvictionMoment& moment) noexcept {
  approached_ = false;
  const bool elsewhere = moment.zone != zone_ || moment.zone_before != zone_before_;
  if (elsewhere || !std::ranges::equal(moment.ahead, ahead())) {
    zone_ = moment.zone;
    zone_before_ = moment.zone_before;
    ahead_count_ = std::min(moment.ahead.size(), ahead_.size());
    std::copy_n(moment.ahead.begin(), ahead_count_, ahead_.begin());
    forecast_.begin(zone_before_, zone_, ahead());
  } else {
    forecast_.advance();
  }
}

void ExpectedUse::requested(ZoneId zone, bool /*resident*/) noexcept {
  loss_ = std::max(loss_ - shadow_.request(zone), -most_credit_);
  // Approached, the first of a cycle before the others: what comes after it counts.
  if (approached_ || zone == zone_ || zone_ == kNoZone || ahead_count_ > 0) return;
  approached_ = true;
  forecast_.begin(zone_, zone, {});
}

void ExpectedUse::loaded(ZoneId /*zone*/, ZoneNeed need) noexcept { loss_ += need.slots; }

ZoneId ExpectedUse::choose(const EvictionCandidates& candidates) noexcept {
  if (loss_ > most_loss_) follows_shadow_ = true;
  if (loss_ <= 0) follows_shadow_ = false;
  return follows_shadow_ ? first_outside_shadow(candidates) : least_expected(candidates);
}

bool ExpectedUse::goes_before(ZoneId zone, ZoneId colder) noexcept {
  return !follows_shadow_ && forecast_.value(zone) < forecast_.value(colder);
}

ZoneId ExpectedUse::least_expected(const EvictionCandidates& candidates) noexcept {
  ZoneId least = candidates.coldest();
  float value = forecast_.value(least);
  ZoneId zone = candidates.warmer(least);
  for (int looks = 1; looks < kMostLooks && zone != kNoZone; ++looks) {
    if (const float other = forecast_.value(zone); other < value) {
      value = other;
      least = zone;
    }
    zone = candidates.warmer(zone);
  }
  return least;
}

ZoneId ExpectedUse::first_outside_shadow(const EvictionCandidates& candidates) const noexcept {
  ZoneId zone = candidates.coldest();
  for (int looks = 0; looks < kMostLooks && zone != kNoZone; ++looks) {
    if (!shadow_.holds(zone)) return zone;
    zone = candidates.warmer(zone);
  }
  return candidates.coldest();
}

}  // namespace zonepack
