// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

struct TrackerSettings {
  // How deep the pose must be in another zone before it counts, so that noise on a border does not
  // switch back and forth: one sigma within these limits, where a portal leads from the zone the
  // robot was in ...
  double least_depth_m = 0.05;
  double most_depth_m = 0.15;
  // ... and where no portal leads, this plus three sigma: robots do not drive through walls.
  double wall_depth_m = 0.3;
  // A pose outside of every zone starts in the nearest one within this plus three sigma.
  double start_radius_m = 1.0;
};

// The zone the robot is in, from its pose, with hysteresis.
//
// Real-time: no allocation; a cycle looks at the current zone's border, once at the zone graph and
// at the portals of one zone.
// Threads: owned by the control thread.
class ZoneTracker {
 public:
  explicit ZoneTracker(const ZoneGraph& graph, const TrackerSettings& settings = {});

  // Takes the pose of this cycle; an invalid one changes nothing. True when the zone changed.
  bool update(const PoseEstimate& pose) noexcept;

  // Forgets where the robot was: the next pose decides alone, as after re-initialisation.
  void restart() noexcept {
    restart_ = true;
    confirmed_from_ = kNoZone;
  }

  // The robot is in no zone until the next pose.
  void forget() noexcept {
    restart();
    zone_ = pose_zone_ = kNoZone;
  }

  // The robot was seen passing into `zone` from the zone it was in: believed over a pose that lags
  // behind, until the pose is inside too, or more than reach_m plus three sigma from the portals
  // between the two.
  void confirm(ZoneId zone, double reach_m) noexcept;

  // kNoZone before the first valid pose in or near a zone.
  ZoneId zone() const noexcept { return zone_; }

  // The zone that holds the pose itself: the next zone() if the pose stays there. Equals zone()
  // when the pose is inside of it or outside of all.
  ZoneId pose_zone() const noexcept { return pose_zone_; }

 private:
  bool keeps_confirmed(Point2 point, double sigma_m) noexcept;
  bool portal_leads_to(ZoneId to, Point2 point, double reach_m) const noexcept;

  const ZoneGraph& graph_;
  TrackerSettings settings_;
  ZoneId zone_ = kNoZone;
  ZoneId pose_zone_ = kNoZone;
  bool restart_ = true;
  ZoneId confirmed_from_ = kNoZone;  // of a confirmed zone that the pose has not reached
  double confirmed_reach_m_ = 0;
};

}  // namespace zonepack
