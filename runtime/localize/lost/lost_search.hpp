// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/localize/lost/lost_view.hpp"
#include "runtime/localize/lost/place_matcher.hpp"

namespace zonepack::localize {

// When a place is believed: one rule for every map. Views that agree through the wheels are for a
// place; each adds its distinct inliers beyond chance, and a view that should see the place and
// does not takes something away.
struct LostRule {
  int least_distinct = 15;                   // of a view that is for a place
  double least_explained = kLeastExplained;  // distinct / visible, of the same
  double chance = .12;  // of the features near projected points: those that agree anywhere, at most
  int should_see = kShouldSee;  // speaks_against()
  double against_costs = 8;
  double least_support = 36;
  // Between two of the views, one of these. Of two views alone the first: a robot that only turns
  // may see the same pattern of a floor twice, in a wrong place.
  double moved_m = 0.3, turned_rad = 0.26;
  double most_rival = 0.6;  // of what is for the place
};

// A place that a search believes or leans to.
struct LostPlace {
  Pose2 T_map_wheels;              // the wheels' frame in the map
  std::vector<std::size_t> views;  // that agree, by place in views(), most inliers first
  std::vector<Sight> sights;       // of each
  double evidence = 0;             // of the views that agree
  double support = 0;              // the same, less what the views against it cost
  double rival = 0;                // evidence for the best place elsewhere
  int against = 0;                 // views that should see it and do not
  double moved_m = 0, turned_rad = 0;
};

// Finds where a robot is that knows nothing but how it moved: views are buffered, the signatures of
// one zone after the other are matched with all of them, and a place is found when views agree on
// it while the robot moved or turned. A place without a rival is looked at again with the query
// around a known place, which is many times stronger than brute force.
//
// Threads: one.
// Memory: at most kMostViews views, of 30 KiB each with 400 features, and what was seen of them.
class LostSearch {
 public:
  static constexpr std::size_t kMostViews = 20;
  // A view is kept when the robot moved or turned this much since the one before.
  static constexpr double kApart_m = 0.1, kApart_rad = 0.087;

  explicit LostSearch(PlaceMatcher& matcher, const LostRule& rule = {})
      : matcher_(matcher), rule_(rule) {}

  // Keeps the view when it shows something else than the last one; over kMostViews, the oldest one
  // that supports no place goes. False: not kept.
  bool add(LostView view);
  // The wheels were lost track of: what was seen before means nothing any more.
  void restart();

  // Matches one zone with every view that it was not matched with, and looks again at the places
  // that lead. Returns the pairs of view and signature that were compared by brute force.
  std::size_t match(ZoneId zone, std::span<const MapFeatures* const> map);

  // Views that the zone was not matched with.
  std::size_t unmatched(ZoneId zone) const noexcept;

  // The place that leads, and whether it is found.
  std::optional<LostPlace> leading() const;
  bool found(const LostPlace& place) const noexcept;

  // Zones in which the leading places were seen, best first: worth another look with new views.
  std::vector<ZoneId> leading_zones() const;

  std::span<const LostView> views() const noexcept { return views_; }
  const LostRule& rule() const noexcept { return rule_; }

 private:
  struct Seen {
    std::size_t view = 0;
    ZoneId zone = kNoZone;
    Sight sight;
    Pose2 T_map_wheels;
  };
  struct Checked {
    std::uint64_t view = 0;
    ZoneId zone = kNoZone;
    Pose2 pose;
    int expected = 0, distinct = 0;
  };
  struct Cluster {
    LostPlace place;
    std::vector<ZoneId> zones;
  };

  bool counts(const Sight& sight) const noexcept;
  double evidence(const Sight& sight) const noexcept;
  bool agree(const Seen& a, const Seen& b) const noexcept;
  Pose2 carried(const Seen& from, std::size_t to) const noexcept;
  Cluster around(const Seen& centre, bool all) const;
  std::vector<Cluster> clusters(std::size_t most, bool all) const;
  void look_again(ZoneId zone, std::span<const MapFeatures* const> map);
  bool was_checked(std::uint64_t view, ZoneId zone, const Pose2& pose) const noexcept;

  PlaceMatcher& matcher_;
  LostRule rule_;
  std::vector<LostView> views_;
  std::vector<Seen> seen_;
  std::vector<Checked> checked_;
  std::vector<std::vector<bool>> matched_;  // by view, by zone
};

}  // namespace zonepack::localize
