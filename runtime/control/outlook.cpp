// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/outlook.hpp"

#include <algorithm>
#include <limits>

namespace zonepack {
namespace {

// How long before a zone is entered its path gives it away at least: a load that takes no longer is
// not made earlier.
constexpr double kPathGives_s = 0.5;
// A likely zone is loaded so many times its loading before it is expected: until then a step of the
// robot may show better what comes.
constexpr double kEarly = 3;
constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

}  // namespace

Outlook::Outlook(const ZoneGraph& graph, std::span<const float> load_s, Transitions* transitions,
                 const PreloadSettings& settings, bool learns)
    : graph_(graph),
      load_s_(load_s),
      transitions_(transitions),
      preloads_(uses_habits(settings)),
      learns_(learns && transitions != nullptr),
      pays_(settings.pays) {}

void Outlook::enter(ZoneId own, std::int64_t t_ns) noexcept {
  const ZoneSteps::Step* const step = steps_.enter(graph_, own, t_ns);
  if (step != nullptr && learns_) {
    transitions_->learn(step->before, step->now, step->next, step->stay_ns);
  }
  look_from(own);
}

void Outlook::look_from(ZoneId own) noexcept {
  step_on_route(own);
  foresee(own);
}

void Outlook::hint(std::span<const ZoneId> route, ZoneId own) noexcept {
  route_length_ = 0;
  for (const ZoneId zone : route.first(std::min(route.size(), route_.size()))) {
    if (zone < graph_.zone_count()) route_[route_length_++] = zone;
  }
  route_place_ = 0;
  look_from(own);
}

std::span<const ZoneId> Outlook::ahead(ZoneId own) const noexcept {
  if (route_place_ >= route_length_ || route_[route_place_] != own) return {};
  return {route_.data() + route_place_ + 1, route_length_ - route_place_ - 1};
}

// The robot's zone on the route, searched from where it was: a route may lead through a zone twice.
void Outlook::step_on_route(ZoneId own) noexcept {
  for (std::size_t i = 0; i < route_length_; ++i) {
    const std::size_t place = (route_place_ + i) % route_length_;
    if (route_[place] != own) continue;
    route_place_ = place;
    return;
  }
}

// Which zones may come, and which of them are worth loading before they are approached. In the
// order in which they are trusted: the route, then what was learned.
void Outlook::foresee(ZoneId own) noexcept {
  likely_count_ = 0;
  foresight_.clear();
  const std::span<const ZoneId> ahead = this->ahead(own);
  if (!ahead.empty()) {
    foresight_.follow(ahead, steps_.before(), own, transitions_);
  } else if (preloads_ && transitions_ != nullptr && own != kNoZone) {
    foresight_.look(*transitions_, steps_.before(), own);
  }
  double before_s = 0;  // for loading all that is listed so far
  for (const Coming& coming : foresight_.coming()) {
    if (likely_count_ == likely_.size()) break;
    if (coming.zone == own || !graph_.loadable(coming.zone)) continue;
    const double share = static_cast<double>(coming.share);
    const double load_s = static_cast<double>(load_s_[coming.zone]);
    // What its path alone would leave the robot to wait for, against the reading that may be for
    // nothing: both grow with the zone's bytes.
    const double saved_s = share * (load_s - kPathGives_s);
    if (ahead.empty() && saved_s < pays_ * (1 - share) * load_s) continue;
    if (ahead.empty() && saved_s <= 0) continue;
    before_s += load_s;
    const double early_s =
        static_cast<double>(coming.seconds) - kEarly * load_s - (ahead.empty() ? 0 : before_s);
    std::int64_t from_ns = steps_.since_ns();
    if (saved_s <= 0) {
      from_ns = kNever_ns;                                // its path gives it away early enough
    } else if (early_s > 0 && transitions_ != nullptr) {  // else nothing is known of times
      from_ns += static_cast<std::int64_t>(early_s * 1e9);
    }
    likely_[likely_count_++] = {coming.zone, from_ns};
  }
  // The destination, however far, takes the last place.
  if (!ahead.empty() && likely_count_ == likely_.size()) likely_.back().zone = ahead.back();
}

void Outlook::take_over(const Outlook& other) noexcept {
  if (transitions_ != nullptr && other.transitions_ != nullptr) {
    transitions_->take_over(*other.transitions_);
  }
}

}  // namespace zonepack
