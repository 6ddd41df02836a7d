// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/pack_format/ids.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// A beacon that reports when the robot passes it: in a door between two zones, or, without `other`,
// somewhere beyond the doors of one.
struct ZoneMarkerSettings {
  std::string name;  // for messages
  std::string zone, other;
  double reach_m = 1;  // how far from the portal the beacon may answer
};

// The zone in which the robot is after passing a marker, or a static word that says why the marker
// is not believed.
struct MarkerVerdict {
  ZoneId zone = kNoZone;
  const char* refused = nullptr;
};

// What passing a marker says about the robot's zone: believed only where the pose, give or take
// three sigma, is at the portal, and for a door only while the robot moves through it.
//
// Real-time: pass() looks at the portals of one zone; no allocation.
// Threads: immutable.
class ZoneMarkers {
 public:
  // `graph` must outlive this object.
  ZoneMarkers(const ZoneGraph& graph, std::span<const ZoneMarkerSettings> markers);

  std::size_t size() const noexcept { return markers_.size(); }
  double reach_m(std::size_t marker) const noexcept { return markers_[marker].reach_m; }

  // current: the robot's zone before the marker. Refused: "no such zone", "no pose", "elsewhere",
  // "standing".
  MarkerVerdict pass(std::size_t marker, const PoseEstimate& pose, ZoneId current) const noexcept;

  // Fails when a marker names a zone that the map does not have, or a door without a portal.
  static Outcome<void> check(const ZoneGraph& graph, std::span<const ZoneMarkerSettings> markers);

 private:
  struct Marker {
    ZoneId zone = kNoZone;
    ZoneId other = kNoZone;
    bool door = false;
    double reach_m = 0;
  };
  const Exit* near_exit(ZoneId from, ZoneId to, Point2 point, double reach_m) const noexcept;

  const ZoneGraph& graph_;
  std::vector<Marker> markers_;
};

}  // namespace zonepack
