// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "runtime/localize/lost/lost_search.hpp"
#include "runtime/localize/lost/zone_order.hpp"

namespace zonepack::localize {

// A moment at which an image was taken, whether or not it was kept as a view.
struct ViewMoment {
  std::int64_t stamp_ns = 0;
  Pose2 T_wheels_base;
};

// A fix that a search gives once the robot is found.
struct FoundFix {
  std::int64_t stamp_ns = 0;
  Pose2 pose;
  double sigma_m = 0, sigma_rad = 0;
  std::optional<Sight> seen;  // nothing: carried there by the wheels
};

// Fixes for the moments: that of the view itself where it agrees with the place, else the place's
// best view carried there by the wheels. Wider by 3 % of the way and turn.
std::vector<FoundFix> fixes_at(std::span<const ViewMoment> moments, const LostSearch& search,
                               const LostPlace& place);

// Leads a lost robot's search through the zones of a map, one in memory at a time: which zone
// to load next, when to ask for a turn, when the robot is found. It neither loads nor waits: its
// caller does, and reports the outcome.
//
// Threads: one.
class LostSweep {
 public:
  // A zone that did not come within this is passed over in this round: no room, or damage.
  static constexpr std::int64_t kPatience_ns = 8'000'000'000;
  static constexpr std::size_t kMostLeading = 2;  // zones of leading places
  static constexpr std::int64_t kTurnAgain_ns = 15'000'000'000;
  static constexpr std::size_t kMostMoments = 3;  // the newest images, which are given a fix
  static constexpr std::int64_t kOldest_ns = 4'000'000'000;  // of those

  // `matcher` must outlive this object.
  LostSweep(std::vector<SearchZone> map, PlaceMatcher& matcher, const LostRule& rule = {});

  void begin(std::int64_t now_ns, ZoneId last);
  // Lets go of the views.
  void end();
  bool active() const noexcept { return active_; }

  // An image was taken.
  void see(LostView view);
  // Nothing is known of how the robot moved meanwhile.
  void forget_views();

  // The zone to look at next, while there is a view that it was not matched with. Round by round
  // through the map, in memory first, then in order; after the first round every second look goes
  // to a zone of the leading places.
  ZoneId next(std::int64_t now_ns, const std::function<bool(ZoneId)>& resident);
  // The zone that next() gave is in memory: returns how many pairs of a view and a signature were
  // compared.
  std::size_t look(ZoneId zone, std::span<const MapFeatures* const> map);

  // Every zone was seen or passed over, and no place fits the views well enough: other views are
  // needed. True at most every kTurnAgain_ns.
  bool asks_for_turn(std::int64_t now_ns);

  // When the robot is found: fixes for the newest images, at least two.
  std::vector<FoundFix> found(std::int64_t now_ns) const;

  const LostSearch& search() const noexcept { return search_; }
  std::size_t zones() const noexcept { return map_.size(); }
  std::size_t looked_at() const noexcept;  // zones, in this search
  // Zones that did not come in time, each once for each time.
  std::span<const ZoneId> passed_over() const noexcept { return passed_over_; }

 private:
  bool may_try(ZoneId zone) const noexcept;
  ZoneId choose(const std::function<bool(ZoneId)>& resident) const;

  std::vector<SearchZone> map_;
  LostSearch search_;
  bool active_ = false;
  std::vector<ZoneId> order_;
  std::vector<std::size_t> looks_;   // by zone, in this search
  bool led_ = false;                 // the last look was at a leading place
  std::vector<std::size_t> failed_;  // by zone: views there were when it was passed over, plus 1
  std::vector<ZoneId> passed_over_;
  std::vector<ViewMoment> moments_;  // the newest last
  std::uint64_t views_ = 0;          // kept so far
  ZoneId waiting_ = kNoZone;
  std::int64_t waiting_since_ns_ = 0;
  std::optional<std::int64_t> turn_asked_ns_;
};

}  // namespace zonepack::localize
